#include "bake/make_tracer.h"

#include "tracers/embree/embree.h"
#include "tracers/march/march.h"
#include "tracers/slice/slice.h"

namespace hemibake {
namespace {

RayOptions ray_options(const BakeSettings& settings) {
  RayOptions rays;
  rays.rays = *settings.rays;
  rays.cone_degrees = settings.cone_degrees;
  if (settings.max_distance_m) rays.max_distance_m = *settings.max_distance_m;
  rays.directions = *settings.directions;
  rays.patch_kind = *settings.patch_kind;
  rays.texel_links = settings.texel_links;
  rays.seed = settings.seed;
  return rays;
}

SliceOptions slice_options(const BakeSettings& settings) {
  SliceOptions slices;
  slices.azimuths = *settings.rays;
  if (settings.max_distance_m) slices.max_distance_m = *settings.max_distance_m;
  slices.patch_kind = *settings.patch_kind;
  slices.texel_links = settings.texel_links;
  slices.seed = settings.seed;
  return slices;
}

MarchOptions march_options(const LoadedMap& map, const BakeSettings& settings) {
  MarchOptions march;
  march.rays = *settings.rays;
  march.cone_degrees = settings.cone_degrees;
  if (settings.max_distance_m) march.max_distance_m = *settings.max_distance_m;
  march.max_steps = settings.max_steps;
  march.lift_percent = settings.lift_percent;
  march.ray_set = settings.ray_set;
  march.weights = settings.weights;
  march.lookup = settings.lookup;
  march.seed = settings.seed;
  march.amplitude_m = map.amplitude_m;
  march.lowest_m = map.lowest_m;
  march.normal_lengths = map.normal_lengths;
  return march;
}

}  // namespace

std::unique_ptr<Tracer> make_tracer(const LoadedMap& map, const BakeSettings& settings) {
  switch (*settings.tracer) {
    case TracerKind::kEmbree:
      return make_embree_tracer(map.surface, ray_options(settings));
    case TracerKind::kSlice:
      return make_slice_tracer(map.surface, slice_options(settings));
    case TracerKind::kMarch:
      break;
  }
  return make_march_tracer(map.surface, march_options(map, settings));
}

size_t tracer_bytes(uint32_t texels, uint32_t facets, const BakeSettings& settings) {
  switch (*settings.tracer) {
    case TracerKind::kEmbree:
      return embree_scene_bytes(facets);
    case TracerKind::kSlice:
      return slice_tracer_bytes(texels, slice_options(settings), settings.needs_form_factors());
    case TracerKind::kMarch:
      break;
  }
  return size_t{8} * texels;
}

}  // namespace hemibake
