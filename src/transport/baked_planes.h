// The planes of a finished bake, as in BAKE.exr. Planes that were not asked for are empty.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/grid.h"

namespace hemibake {

// Texels that are holes of the surface have no values: NaN in every plane.
struct Bake {
  int width = 0;
  int height = 0;
  Grid<float> visible_fraction;         // channel `ao`: α, the uniform visible fraction, 0..1
  Grid<float> visibility;               // channel `visibility`: V = E₀/π, the cosine-weighted one, 0..1
  std::vector<Grid<float>> irradiance;  // channels `irradiance.00`…: E_b at albedo 1, 0..π
  Grid<float> total;                    // channel `total`: all bounces at albedo 1, 0..π
  Grid<float> residual;                 // channel `residual`: (π − Σ)/π not yet summed at albedo 1
  Grid<float> bounce;                   // channel `bounce`: E/π of all bounces at albedo bounce_albedo, 0..1
  double bounce_albedo = 0;             // inside 0..1 where `bounce` is there
  Grid<glm::vec3> normals;              // channels `normal.X/Y/Z`
  Grid<glm::vec3> bent_normals;         // channels `bent.X/Y/Z`
};

// Returns whether a texel is a hole: none of its planes has a number. A bake without planes has no holes.
bool is_hole(const Bake& bake, size_t texel);

// Returns which texels are holes, 1; empty where none is.
Grid<uint8_t> holes_of(const Bake& bake);

// Takes the values of holes away. holes: of the bake's size; empty: none.
void clear_holes(const Grid<uint8_t>& holes, Bake& bake);

// Gives holes the values of flat open ground, for what needs a number in every texel.
void show_holes_as_open_ground(Bake& bake);

}  // namespace hemibake
