// The trade study for the terminal.
#pragma once

#include <string>

#include "trade/study.h"

namespace hemibake {

// Lists the representative runs, the models on the true AO, and the precision of the reference.
std::string text_of_study(const Study& study);

}  // namespace hemibake
