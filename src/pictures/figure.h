// Figures: pictures beside each other, with captions and scale bars. Colours are sRGB-encoded, 0..1, ready
// for a PNG.
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

// Linear values brought to a longer side of `side` pixels (means over the area of each), or magnified by a
// whole number to as near below that as it goes.
Grid<glm::vec3> scaled(const Grid<glm::vec3>& linear, int side);
Grid<float> scaled(const Grid<float>& values, int side);

// 0..1 (or −1..1) to linear sRGB.
using ColorMap = std::function<glm::dvec3(double)>;

// A number per pixel as a colour: `map` over low..high. clipped: how many were beyond.
struct ColorScale {
  ColorMap map;
  double low = 0, high = 1;  // what the map's ends stand for
  double map_low = 0;        // 0, or −1 for a diverging map
  std::string label;         // under the scale bar, what the number is
};
Grid<glm::vec3> colored(const Grid<float>& values, const ColorScale& scale, size_t& clipped);

// A bar of the scale with its ends and middle written under it, `width` pixels wide.
Grid<glm::vec3> scale_bar(const ColorScale& scale, int width);

// Rows of panels, one above the other, each centred; `below` under everything (scale bars), also centred.
Grid<glm::vec3> make_figure(std::span<const std::vector<Panel>> rows,
                            std::span<const Grid<glm::vec3>> below = {});

// Where nothing is drawn, in figures.
inline constexpr glm::vec3 kPaper{1, 1, 1};

}  // namespace hemibake
