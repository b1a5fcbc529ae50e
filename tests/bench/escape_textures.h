// Two and three textures that hold all bounces, and albedo that varies: the tables of the escape bench.
#pragma once

#include <vector>

#include "bench/escape_truth.h"

namespace hemibake {

// Prints what a pair of textures (V and E at an albedo r) and a triple leave, by r, bits and box filter.
void print_textures(const std::vector<MapTruth>& maps);

// Prints what the blur rule leaves on the painted maps, beside other weights and levels.
void print_albedo(const std::vector<MapTruth>& maps);

// Returns the mean of n × n texels; rows and columns that do not fill one are left out.
Grid<float> box_filtered(const Grid<float>& plane, int n);

}  // namespace hemibake
