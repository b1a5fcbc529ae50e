// Packs a block of form factors.
#pragma once

#include "transport/links/form_factors.h"

namespace hemibake {

// Returns the rows as a block in memory, without open rows.
FormFactorBlock pack_block(const OpenRows& open);

}  // namespace hemibake
