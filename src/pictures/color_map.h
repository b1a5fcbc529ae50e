// Maps numbers to colours of Oklab (B. Ottosson, "A perceptual color space for image processing", 2020):
// equal steps of the number are equal steps of lightness, in print and for colour-blind eyes too.
#pragma once

#include <glm/vec3.hpp>

namespace hemibake {

// Convert between Oklab and linear sRGB; channels are outside 0..1 where no screen has the colour.
glm::dvec3 linear_from_oklab(const glm::dvec3& lab);
glm::dvec3 oklab_from_linear(const glm::dvec3& linear);

// Returns linear sRGB, 0..1. value: 0..1, dark blue to light yellow, lightness in proportion.
glm::dvec3 sequential_color(double value);

// Returns linear sRGB, 0..1. value: −1..1, blue to red over near white, the same lightness at v and −v.
glm::dvec3 diverging_color(double value);

// Returns the smallest of 1, 1.5, 2, 2.5, 3, 4, 5, 6, 8 times 10ⁿ not below `value`; 1 for 0.
double round_scale(double value);

}  // namespace hemibake
