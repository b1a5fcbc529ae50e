// How a block of links is made from its rows.
#pragma once

#include "transport/links/form_factors.h"

namespace hemibake {

// The rows as a block in memory, without open rows.
FormFactorBlock pack_block(const OpenRows& open);

}  // namespace hemibake
