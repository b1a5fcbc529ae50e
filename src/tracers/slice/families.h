// The paths of every family of receivers: the texels, and each node of either half of the cells.
#pragma once

#include <cstdint>
#include <vector>

#include "surface/patches.h"
#include "tracers/slice/path.h"

namespace hemibake {

struct SliceFamilies {
  SlicePaths texels;
  std::vector<SlicePaths> nodes;  // by node_family; empty where patches are texels
};

// azimuths: of a texel. seed: which rotations, and where in their small copies of the facet nodes start.
SliceFamilies make_slice_families(int azimuths, PatchKind patches, uint64_t seed);

// Memory that a family's ready segments take, about, bytes.
size_t ready_bytes(const SlicePaths& paths);

// By half of the cell and node.
size_t node_family(uint32_t half, uint32_t node);

}  // namespace hemibake
