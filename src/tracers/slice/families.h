// Makes the paths of every family of receivers: the texels, and each node of either half of the cells.
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

// Makes all families. azimuths: of a texel. seed: of the rotations and of the starts of nodes.
SliceFamilies make_slice_families(int azimuths, PatchKind patches, uint64_t seed);

// Estimates the bytes of a family's cached segments.
size_t cache_bytes(const SlicePaths& paths);

// Returns the index of a node's family.
size_t node_family(uint32_t half, uint32_t node);

}  // namespace hemibake
