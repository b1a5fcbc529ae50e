// Text on pictures. Needs a font of the system (scripts/setup installs it); without one there is no text.
#pragma once

#include <glm/vec3.hpp>
#include <string_view>

#include "core/grid.h"

namespace hemibake {

// Whether text can be drawn here.
bool has_font();

// Width and height of a line of text, pixels; 0 without a font. size: of the letters, pixels.
struct TextSize {
  int width = 0, height = 0;
};
TextSize text_size(std::string_view text, int size);

// Draws a line of text, ASCII (OpenImageIO 2.4 gets other letters wrong), beginning at x with its letters
// standing on y. What is outside the picture is left out. Without a font nothing is drawn.
void draw_text(Grid<glm::vec3>& picture, int x, int y, std::string_view text, int size,
               const glm::vec3& color);

}  // namespace hemibake
