// Text on pictures. Needs a font of the system (scripts/setup installs it); without one there is no text.
#pragma once

#include <glm/vec3.hpp>
#include <string_view>

#include "core/grid.h"

namespace hemibake {

// Returns whether text can be drawn here.
bool has_font();

// Width and height of a line of text in pixels; 0 without a font.
struct TextSize {
  int width = 0, height = 0;
};
// size: of the letters, pixels.
TextSize text_size(std::string_view text, int size);

// Draws a line of text, cut at the borders; nothing without a font.
// x, y:  left end of the baseline, pixels.
// text:  ASCII (OpenImageIO 2.4 draws other letters wrongly).
// size:  of the letters, pixels.
// color: as the picture's values.
void draw_text(Grid<glm::vec3>& picture, int x, int y, std::string_view text, int size,
               const glm::vec3& color);

}  // namespace hemibake
