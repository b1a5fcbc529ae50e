// Makes the paths of every family of receivers: the texels, and the nodes of every site.
#pragma once

#include <cstdint>
#include <vector>

#include "surface/patches.h"
#include "tracers/slice/path.h"

namespace hemibake {

struct SliceFamilies {
  SlicePaths texels;
  std::vector<SlicePaths> nodes;  // by site (surface/node_sites.h); empty where patches are texels
};

// Makes all families. azimuths: of a texel. seed: of the rotations.
SliceFamilies make_slice_families(int azimuths, PatchKind patches, uint64_t seed);

// Estimates the bytes of a family's cached segments.
size_t cache_bytes(const SlicePaths& paths);

}  // namespace hemibake
