// Progress on a terminal: one line on standard error that is written over.
#pragma once

#include "core/context.h"

namespace hemibake {

// Draws the line with rate and time left, or clears it where the step is finished. Only for terminals.
void draw_progress_line(const ProgressReport& report);

}  // namespace hemibake
