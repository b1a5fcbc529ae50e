#include <fmt/format.h>

#include <utility>

#include "bake/settings.h"
#include "core/error.h"

namespace hemibake {
namespace {

// Azimuths and rays that serve most maps (src/tracers/README.md).
constexpr int kDefaultAzimuths = 64, kDefaultRays = 256;
constexpr int kMaxAzimuths = 65536;

// Applies what the preset stands for, where the user did not set it.
void apply_mayaux2018(MapSettings& map, BakeSettings& settings, const IsGiven& given) {
  const auto set = [&given](const char* name, auto& setting, const auto& value) {
    if (!given(name)) setting = value;
  };
  const MarchOptions march = mayaux2018_march();
  const FilterOptions filter = mayaux2018_filter();
  set("tracer", settings.tracer, TracerKind::kMarch);
  set("rays", settings.rays, march.rays);
  set("cone", settings.cone_degrees, march.cone_degrees);
  set("max-steps", settings.max_steps, march.max_steps);
  set("lift", settings.lift_percent, march.lift_percent);
  set("filter-radius", map.filter.radius, filter.radius);
  set("filter-tolerance", map.filter.tolerance, filter.tolerance);
  set("filter-sum", map.filter.sum, filter.sum);
  set("ray-set", settings.ray_set, march.ray_set);
  set("lookup", settings.lookup, march.lookup);
  set("normalize", settings.weights, march.weights);
  if (map.normal_map.empty()) return;
  set("normal-length", settings.normal_length, NormalLength::kStored);
  set("normal-y", map.normal_y, NormalY::kUp);
}

void validate_target_error(const BakeSettings& settings, const IsGiven& given) {
  if (!settings.target_error) {
    if (settings.explain) throw SettingError("{explain}: explains {target-error}, expected it too");
    return;
  }
  if (settings.tracer == TracerKind::kMarch)
    throw SettingError(
        "{target-error}: a march has errors that rays do not mend, expected {tracer} embree or slice");
  if (settings.max_distance_m || settings.cone_degrees < 180)
    throw SettingError(
        "{target-error}: is against the whole hemisphere, expected neither {max-distance} nor {cone}");
  for (const char* chosen : {"rays", "bounces"})
    if (given(chosen))
      throw SettingError(
          fmt::format("{{{}}}: is chosen by {{target-error}}, expected one of the two", chosen));
}

void validate_edge(const MapSettings& map, const BakeSettings& settings) {
  if (settings.margin > 0 && map.edge == Edge::kWrap)
    throw SettingError("{margin}: a map that repeats has no ring around it, expected {edge} open or ground");
  if (settings.margin > 0 && settings.keep_transport)
    throw SettingError("{margin}: links are between all texels, expected no {links} with it");
  if (map.edge != Edge::kGround) return;
  if (settings.tracer == TracerKind::kMarch)
    throw SettingError(
        "{edge}: a march knows no ground beyond the border, expected wrap or open with {tracer} march");
  if (settings.max_distance_m)
    throw SettingError(
        "{max-distance}: ground beyond the border has no end, expected {edge} wrap or open with it");
}

void validate_tracer(const BakeSettings& settings) {
  if (settings.tracer == TracerKind::kMarch && settings.patch_kind == PatchKind::kFacets)
    throw SettingError("{patches}: a march knows no facets, expected texels with {tracer} march");
  if (settings.tracer != TracerKind::kSlice) return;
  if (*settings.rays > kMaxAzimuths)
    throw SettingError(fmt::format("{{rays}}: {} azimuths, expected at most {} with {{tracer}} slice",
                                   *settings.rays, kMaxAzimuths));
  if (settings.cone_degrees < 180)
    throw SettingError("{cone}: slices serve the whole hemisphere, expected 180 with {tracer} slice");
}

void validate_normals(const MapSettings& map, const BakeSettings& settings, const IsGiven& given) {
  const bool has_map = map.normals_from == NormalSource::kMap;
  if (has_map && map.normal_map.empty())
    throw SettingError("{normals-from}: a normal map has a file, expected {normals} FILE");
  const std::pair<const char*, bool> of_a_map[] = {{"normal-y", map.normal_y || map.decide_normal_y},
                                                   {"normal-channels", !map.normal_channels.empty()},
                                                   {"normal-encoding", map.normal_encoding.has_value()}};
  for (const auto& [name, is_set] : of_a_map)
    if (!has_map && is_set)
      throw SettingError(
          fmt::format("{{{}}}: there is no normal map, expected {{normals}} FILE with it", name));
  if (has_map && given("normals-from"))
    throw SettingError("{normals-from}: normals come from a normal map already, expected one of the two");
  if (settings.normal_length == NormalLength::kStored && (!has_map || settings.tracer != TracerKind::kMarch))
    throw SettingError("{normal-length}: stored lengths need {normals} and {tracer} march, expected both");
}

void validate_units(const MapSettings& map, const IsGiven& given) {
  const auto exclude = [&given](const char* one, const char* other) {
    if (given(one) && given(other))
      throw SettingError(fmt::format("{{{}}}: is given with {{{}}}, expected one of the two", one, other));
  };
  exclude("texel", "size");
  exclude("high", "amplitude");
  exclude("low", "amplitude");
  if (map.low_m && !map.high_m)
    throw SettingError("{low}: is the height of black, expected {high} M for white with it");
  if (map.high_m && map.heights == HeightUnit::kMetres)
    throw SettingError("{high}: scales values of 0..1, expected no {heights} metres with it");
}

}  // namespace

void resolve_defaults(MapSettings& map, BakeSettings& settings, const IsGiven& given) {
  if (settings.preset == Preset::kMayaux2018) apply_mayaux2018(map, settings, given);
  settings.tracer_is_default = !settings.tracer;
  settings.rays_are_default = !settings.rays;
  if (!settings.tracer) {
    const bool asks_for_rays =
        settings.cone_degrees < 180 || settings.directions || settings.rays.value_or(0) > kMaxAzimuths;
    settings.tracer = asks_for_rays ? TracerKind::kEmbree : TracerKind::kSlice;
  }
  if (!settings.directions) settings.directions = DirectionSet::kUniform;
  if (!settings.rays) settings.rays = settings.tracer == TracerKind::kSlice ? kDefaultAzimuths : kDefaultRays;
  if (!settings.patch_kind)
    settings.patch_kind = settings.tracer == TracerKind::kMarch ? PatchKind::kTexels : PatchKind::kFacets;
  if (!map.normal_map.empty()) map.normals_from = NormalSource::kMap;
}

void resolve_for_holes(const Surface& surface, BakeSettings& settings) {
  if (surface.holes.empty()) return;
  if (settings.tracer != TracerKind::kEmbree) {
    if (!settings.tracer_is_default)
      throw SettingError(
          fmt::format("{{tracer}}: {} know no open holes, expected embree, or {{holes}} fill with it",
                      settings.tracer == TracerKind::kMarch ? "marches" : "slices"));
    settings.tracer = TracerKind::kEmbree;
    if (settings.rays_are_default) settings.rays = kDefaultRays;
  }
  if (settings.target_error)
    throw SettingError(
        "{target-error}: is against slices, which know no open holes, expected {rays}, or {holes} fill");
}

void validate(const MapSettings& map, const BakeSettings& settings, const IsGiven& given) {
  validate_target_error(settings, given);
  validate_tracer(settings);
  validate_edge(map, settings);
  validate_units(map, given);
  validate_normals(map, settings, given);
  if (settings.converge && !settings.wants(BakeOutput::kIrradiance))
    throw SettingError("{converge}: irradiance is not among {outputs}, expected it there");
}

}  // namespace hemibake
