// From light to a screen: exposure, the sRGB curve, and what did not fit.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <span>

#include "core/grid.h"

namespace hemibake {

// Relative luminance of linear sRGB (Rec. 709 primaries).
double luminance(const glm::dvec3& linear);

// 0..1 to 0..1, IEC 61966-2-1.
double srgb_from_linear(double linear);
double linear_from_srgb(double encoded);

// Pixels with a channel that no screen shows.
struct Clipping {
  size_t above_white = 0;
  size_t below_black = 0;
};

// linear · 2^exposure_ev, sRGB-encoded, 0..1.
Grid<glm::vec3> encode_srgb(const Grid<glm::vec3>& linear, double exposure_ev, Clipping& clipping);

// The exposure that brings all but a thousandth of the pixels of all pictures to white or below, in quarters
// of a stop, downwards. 0 where they are all black.
double exposure_for(std::span<const Grid<glm::vec3>* const> pictures);

}  // namespace hemibake
