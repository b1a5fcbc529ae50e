// The bounce map in an integer texture: the steps of V and of E at one more albedo, chosen together.
#pragma once

#include <array>
#include <functional>

#include "core/grid.h"
#include "transport/baked_planes.h"

namespace hemibake {

// Albedos that a bounce map is judged at.
inline constexpr std::array kBounceMapAlbedos = {0.2, 0.5, 0.8, 0.9, 0.95};

// Texels a side of the blocks whose steps are chosen together.
inline constexpr int kBounceMapBlock = 4;

// Holds the light of one texel or the mean of several, over π.
struct MappedLight {
  double visibility = 0, bounce = 0;                             // as stored: at albedo 0 and r
  std::array<double, kBounceMapAlbedos.size()> irradiance = {};  // truth
};

// Returns whether the light at every albedo is known well enough to judge a bounce map: the bake has its
// plane, and three bounces or more (README.md).
bool knows_mapped_light(const Bake& bake);

// Returns the light of one texel. bake: knows_mapped_light.
MappedLight mapped_light_at(const Bake& bake, size_t texel);

// Holds light in row-major order.
struct LightBlock {
  int width = 0, height = 0;  // at most kBounceMapBlock
  std::array<MappedLight, size_t{kBounceMapBlock} * kBounceMapBlock> texels;

  size_t size() const { return static_cast<size_t>(width) * static_cast<size_t>(height); }
};

using LightOfTexel = std::function<MappedLight(size_t texel)>;  // row-major index

// Returns the light of the block at column x and row y, cut at the border of a map of width × height.
LightBlock block_at(int x, int y, int width, int height, const LightOfTexel& light);

struct TexelBox {
  int x = 0, y = 0, width = 1, height = 1;
};

// Returns the mean light of the texels in a box, which lies inside the block.
MappedLight mean_light(const LightBlock& block, const TexelBox& box);

struct StoredPair {
  int visibility = 0, bounce = 0;  // steps
};
using StoredBlock = std::array<StoredPair, LightBlock{}.texels.size()>;  // as the texels of a LightBlock

// Rounds the light of every texel of a block.
// steps: between 0 and 1, 255 for 8 bits.
StoredBlock round_steps(const LightBlock& block, int steps);

// Chooses the steps of a block: V within 1 and the other within 3 of the rounded ones, never below V. Lowers
// Σ_texels e² + 1.5 n ē², never above that of rounding: e² the squared error of V and of E at
// kBounceMapAlbedos summed, of a texel; ē² that of the mean of the n texels, which a mip level holds.
// bounce_albedo: r, inside 0..1.
StoredBlock choose_steps(const LightBlock& block, int steps, double bounce_albedo);

struct BounceMap {
  Grid<float> visibility, bounce;
};

// Chooses the steps of a whole map, block by block. Returns them over `steps`, 0..1.
BounceMap choose_bounce_map(int width, int height, int steps, double bounce_albedo,
                            const LightOfTexel& light);

}  // namespace hemibake
