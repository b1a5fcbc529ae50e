// Measures the synthetic maps whose light has a closed form. Lengths are in texels, texel centres are
// at whole numbers; the heights 0..1 times `depth` texels give the true shape.
#pragma once

#include "surface/synthetic/synthetic.h"

namespace hemibake {

// A pit in flat ground that is the part of a sphere below the polar angle T from its lowest point.
// E_b/π = C(1 − C)^b in the whole pit, C = (1 + cos T)/2. The wall at the rim has slope tan T.
struct BowlGeometry {
  int center_x, center_y;  // the lowest texel
  double rim_radius;       // 0.45 of the shorter side: flat ground all around
  double sphere_radius;
  double depth;  // of the lowest point under the rim
};
BowlGeometry bowl_geometry(int width, int height, double angle_rad);

// Tiled V-grooves along y: vertices at columns 0, period, 2·period …, ridges halfway. The period is an even
// divisor of the width, so that the triangles through the texel centres are exactly the two walls. (An odd
// width has no such period: one groove whose ridge is two columns wide.)
struct GrooveGeometry {
  int period;
  int wall_width;  // horizontal, period / 2
  double depth;    // wall_width / tan ψ
};
GrooveGeometry groove_geometry(int width, double angle_rad);

// Flat floor at height 0 between upper wall edges at height 1 that run along y; walls are one texel wide. The
// floor texel of column x sees the edges at distances x − left_edge and right_edge − x.
struct WallGeometry {
  int left_edge;   // column of the last texel on top to the left of the floor
  int right_edge;  // column of the first texel on top to the right of the floor
};
// Floor in the middle half of the map.
WallGeometry canyon_geometry(int width);
// Floor in the right half: the wall to its left is alone with open edges; where the map repeats, the next one
// rises at column `width`.
WallGeometry step_geometry(int width);

}  // namespace hemibake
