// Screen-space ambient obscurance of the Alchemy engine: M. McGuire, B. Osman, M. Bukowski, P. Hennessy, "The
// Alchemy Screen-Space Ambient Obscurance Algorithm", HPG 2011; taps in a spiral after M. McGuire, M. Mara,
// D. Luebke, "Scalable Ambient Obscurance", HPG 2012, eq. 6-8; as the notes of CS562 join them.
//
// S = (2πc/n) Σ max(0, N·ω_i − δ d_i) H(R − |ω_i|) / max(c², ω_i·ω_i), ω_i = P_i − P, and AO = (1 − sS)₊^k.
// A tap that finds no surface adds nothing.
#pragma once

#include <glm/vec2.hpp>

#include "estimators/bilateral_blur.h"
#include "estimators/estimate.h"
#include "estimators/geometry_buffer.h"

namespace hemibake {

enum class Projection { kOrthographic, kPerspective };

// Passes of the blur that are run.
enum class BlurPasses { kNone, kRows, kBoth };

struct AlchemyOptions {
  int taps = 16;               // n, 1..
  double radius_m = 0;         // R; 0: the height range, at least two texels and at most half the longer side
  double falloff_start = 0.1;  // c/R, above 0
  double bias = 1e-3;          // δ: a threshold per metre of depth
  double scale = 1;            // s
  double contrast = 1;         // k
  Projection projection = Projection::kOrthographic;
  double camera_height_m = 1;  // orthographic: of the camera's plane above the highest texel
  PerspectiveCamera camera;    // perspective
  BlurPasses blur = BlurPasses::kBoth;
  BlurOptions blur_options;
};

// Returns the offset of tap i of n from its pixel, in units of the projected radius R: at distance α = (i +
// ½)/n and angle 2πα·7n/9 + rotation, seven turns of the spiral for every nine taps. rotation: of the pixel's
// spiral, radians.
glm::dvec2 spiral_tap(int i, int taps, double rotation);

// Returns the rotation of a pixel's spiral, radians: (30 x ^ y) + 10 x y.
double spiral_rotation(int x, int y);

// Returns S of every pixel, 0..; 0 without a surface.
Grid<double> alchemy_obscurance(const GeometryBuffer& buffer, const AlchemyOptions& options, double radius_m);

// AO per pixel before the blur, after its pass along the rows and after both. A pass that is not run copies
// its input.
struct AlchemyImages {
  Grid<float> raw, blurred_rows, blurred;
};
// Makes AO of every pixel.
AlchemyImages alchemy_images(const GeometryBuffer& buffer, const AlchemyOptions& options, double radius_m);

// Returns the radius of the options, or their default for the surface.
double alchemy_radius_m(const Surface& surface, const AlchemyOptions& options);

// Estimates AO per texel by the pixel that shows it. Texels that a perspective camera does not see are not
// known. Obscurance is cosine-weighted, but fades with distance: it is no unbiased E₀/π.
Estimate estimate_alchemy(const Surface& surface, const AlchemyOptions& options);

}  // namespace hemibake
