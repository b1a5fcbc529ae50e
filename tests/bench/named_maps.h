// Maps and tracers by name, as a bake has them by default.
#pragma once

#include <memory>
#include <string>

#include "io/image_io.h"
#include "support/maps.h"
#include "tracers/embree/embree.h"
#include "tracers/slice/slice.h"

namespace hemibake {

// wall: the published height map; bricks, shapes, noise: of `side` texels along a side.
inline Surface bench_map(const std::string& name, int side = 256) {
  if (name == "wall")
    return make_surface(read_height_map(HEMIBAKE_REFERENCE_DIR "/WallHeight.png", "G"), 1, 0.1, Edge::kWrap);
  if (name == "bricks") return synthetic_surface(SyntheticKind::kBricks, side, side, 0.1);
  if (name == "noise") return synthetic_surface(SyntheticKind::kNoise, side, side, 0.1);
  return synthetic_surface(SyntheticKind::kShapes, side, side, 0.45);
}

// embree: 256 rays a texel; slice: 32 azimuths.
inline std::unique_ptr<Tracer> bench_tracer(const Surface& surface, const std::string& name) {
  if (name == "embree") return make_embree_tracer(surface, {});
  SliceOptions options;
  options.azimuths = 32;
  return make_slice_tracer(surface, options);
}

}  // namespace hemibake
