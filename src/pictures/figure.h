// Lays out figures: pictures beside each other with captions and scale bars. Colours are sRGB-encoded, 0..1.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/grid.h"

namespace hemibake {

struct Panel {
  Grid<glm::vec3> shown;
  std::string caption;  // above it
};

// Reduces linear values to a longer side of `side` pixels, each the mean over its area, or magnifies them by
// the largest whole number that fits.
Grid<glm::vec3> scaled(const Grid<glm::vec3>& linear, int side);
Grid<float> scaled(const Grid<float>& values, int side);

// Maps 0..1 (or −1..1) to linear sRGB.
using ColorMap = std::function<glm::dvec3(double)>;

// Maps low..high to the colours of `map`.
struct ColorScale {
  ColorMap map;
  double low = 0, high = 1;  // what the map's ends stand for
  double map_low = 0;        // 0, or −1 for a diverging map
  std::string label;         // under the scale bar, what the number is
};

// Colours a number per pixel. clipped: is increased by the pixels beyond the scale.
Grid<glm::vec3> colored(const Grid<float>& values, const ColorScale& scale, size_t& clipped);

// Draws the scale `width` pixels wide, with numbers at its quarters and its label.
Grid<glm::vec3> scale_bar(const ColorScale& scale, int width);

// Stacks rows of panels, and `below` (scale bars) under them, all centred.
Grid<glm::vec3> make_figure(std::span<const std::vector<Panel>> rows,
                            std::span<const Grid<glm::vec3>> below = {});

// Colour of the paper.
inline constexpr glm::vec3 kPaper{1, 1, 1};

}  // namespace hemibake
