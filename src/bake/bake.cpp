#include "bake/bake.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "bake/crop.h"
#include "bake/make_tracer.h"
#include "core/error.h"
#include "core/parallel.h"
#include "surface/facets.h"
#include "tracers/embree/embree.h"
#include "transport/direct_light.h"
#include "transport/links/spill_file.h"

namespace hemibake {
namespace {

constexpr double kGib = 1024.0 * 1024 * 1024;
constexpr uint64_t kErrorSeed = 0x5eed;  // added to the user's: the tracer that tells the noise

PlanOptions plan_options(uint32_t texels, uint32_t facets, const BakeSettings& settings) {
  const bool irradiance = settings.wants(BakeOutput::kIrradiance);
  PlanOptions plan;
  plan.patch_kind = *settings.patch_kind;
  plan.with_links = settings.needs_form_factors();
  plan.bounces = irradiance ? settings.bounces : 0;
  plan.converges = settings.converge.has_value();
  plan.scene_bytes = tracer_bytes(texels, facets, settings);
  if (settings.wants(BakeOutput::kNormal)) plan.kept_planes += 3;
  if (irradiance && !plan.with_links) plan.kept_planes += 3;  // E₀, total, residual
  return plan;
}

PlanOptions plan_options(const Surface& surface, const BakeSettings& settings) {
  return plan_options(surface.texel_count(), facet_count(surface), settings);
}

double allowed_bytes(const BakeSettings& settings) {
  return settings.memory_gib ? *settings.memory_gib * kGib : static_cast<double>(machine_memory_bytes());
}

void refuse_beyond_memory(const BakeSettings& settings, const BakePlan& plan) {
  const double needed = static_cast<double>(plan.memory_bytes()), allowed = allowed_bytes(settings);
  if (needed <= allowed) return;
  throw SettingError("the bake needs " + memory_fault(needed, settings.memory_gib));
}

TargetOptions target_options(const LoadedMap& map, const BakeSettings& settings) {
  TargetOptions target;
  target.error = *settings.target_error;
  target.patch_kind = *settings.patch_kind;
  target.with_light = settings.needs_form_factors() && settings.wants(BakeOutput::kIrradiance);
  if (settings.tracer == TracerKind::kEmbree) target.fewest_rays = 16;
  target.seed = settings.seed;
  target.make_tracer = [&map, &settings](int rays, uint64_t seed) {
    BakeSettings other = settings;
    other.rays = rays;
    other.seed = seed;
    return make_tracer(map, other);
  };
  return target;
}

void choose_rays_and_bounces(PreparedBake& prepared) {
  prepared.choice =
      choose_for_target(prepared.map->surface, target_options(*prepared.map, prepared.settings));
  prepared.settings.rays = prepared.choice->rays;
  if (prepared.choice->bounces > 0) prepared.settings.bounces = prepared.choice->bounces;
}

LightTransport trace(const PreparedBake& prepared, BakeResult& result) {
  const double cpu_start = process_cpu_seconds();
  LightTransport transport = trace_surface(
      *prepared.tracer, prepared.settings.kept_links(),
      prepared.plan.spills ? std::make_shared<SpillFile>(prepared.settings.spill_folder) : nullptr);
  result.counts = transport.counts;
  result.links = transport.final_gather.count() + transport.patch_form_factors.count();
  result.trace_cpu_seconds = process_cpu_seconds() - cpu_start;
  return transport;
}

std::optional<LinkEnergy> energy_of(const PreparedBake& prepared, const LightTransport& transport) {
  if (transport.final_gather.empty()) return std::nullopt;
  return measure_link_energy(prepared.map->surface, prepared.tracer->patch_set(), transport);
}

std::optional<Bounces> bounces_of(const BakeSettings& settings, const LightTransport& transport) {
  if (!settings.wants(BakeOutput::kIrradiance)) return std::nullopt;
  if (!settings.needs_form_factors()) return direct_light(transport);
  BounceOptions options{settings.bounces, settings.converge, settings.max_bounces, std::nullopt};
  if (settings.makes_bounce_plane()) options.bounce_albedo = settings.bounce_albedo;
  return bounce_light(transport, options);
}

std::optional<ErrorEstimate> errors_of(const PreparedBake& prepared, const LightTransport& transport,
                                       const std::optional<Bounces>& bounces) {
  const bool has_a_bounce = bounces && bounces->irradiance.size() > 1;
  if (!prepared.settings.estimate_errors || transport.final_gather.empty() || !has_a_bounce)
    return std::nullopt;
  const auto again = prepared.tracer->reseeded(prepared.settings.seed + kErrorSeed);
  return estimate_errors(*again, transport, *bounces);
}

std::optional<TargetErrors> reached_errors(const PreparedBake& prepared, const LightTransport& transport) {
  if (!prepared.settings.target_error) return std::nullopt;
  return measure_reached(prepared.map->surface, transport, prepared.settings.bounces,
                         target_options(*prepared.map, prepared.settings));
}

void keep_planes(const Surface& surface, LightTransport& transport, BakeResult& result) {
  Bake& planes = result.planes;
  planes.width = surface.width();
  planes.height = surface.height();
  if (result.settings.wants(BakeOutput::kAo)) planes.visible_fraction = std::move(transport.visible_fraction);
  if (result.settings.wants(BakeOutput::kBent)) planes.bent_normals = std::move(transport.bent_normals);
  if (result.settings.wants(BakeOutput::kNormal)) planes.normals = surface.normals;
  const bool irradiance = result.settings.wants(BakeOutput::kIrradiance);
  if (irradiance || result.settings.wants(BakeOutput::kAo)) planes.visibility = transport.direct_over_pi;
  if (!irradiance) return;
  planes.irradiance = std::move(result.bounces->irradiance);
  planes.total = std::move(result.bounces->total);
  planes.residual = std::move(result.bounces->residual);
  planes.bounce = std::move(result.bounces->at_albedo);
  if (!planes.bounce.empty()) planes.bounce_albedo = *result.settings.bounce_albedo;
}

}  // namespace

double least_bake_bytes(int width, int height, const MapSettings& map, const BakeSettings& settings) {
  const auto texels = static_cast<uint32_t>(width) * static_cast<uint32_t>(height);
  const int border = map.edge == Edge::kWrap ? 0 : 1;
  const uint32_t facets = 2 * static_cast<uint32_t>(width - border) * static_cast<uint32_t>(height - border);
  const size_t patches = *settings.patch_kind == PatchKind::kTexels ? texels : size_t{facets} * kCoarseNodes;
  PlanOptions options = plan_options(texels, facets, settings);
  // Open holes may turn slices into rays (resolve_for_holes).
  if (map.holes == Holes::kOpen && settings.tracer_is_default)
    options.scene_bytes = std::min(options.scene_bytes, embree_scene_bytes(facets));
  const BakePlan plan = plan_planes(texels, patches, options);
  return static_cast<double>(plan.memory_bytes() - BakePlan::kProgramBytes);
}

PreparedBake prepare_bake(const LoadedMap& map, const BakeSettings& settings, MemoryLimit limit) {
  PreparedBake prepared;
  check_margin(settings.margin, map.surface.width(), map.surface.height());
  prepared.map = &map;
  prepared.settings = settings;
  resolve_for_holes(map.surface, prepared.settings);
  const bool enforced = settings.limit_memory && limit == MemoryLimit::kEnforced;
  // Twice: before the scene is built, which may be too large already, and with the links a pilot finds.
  if (enforced)
    refuse_beyond_memory(settings, plan_planes(map.surface, plan_options(map.surface, prepared.settings)));
  if (settings.target_error) choose_rays_and_bounces(prepared);
  prepared.tracer = make_tracer(map, prepared.settings);
  if (!settings.limit_memory) return prepared;
  BakePlan& plan = prepared.plan;
  plan = plan_bake(map.surface, *prepared.tracer, plan_options(map.surface, prepared.settings));
  plan.spills = plan.link_bytes > 0 && static_cast<double>(plan.memory_bytes()) > allowed_bytes(settings);
  if (enforced) refuse_beyond_memory(settings, plan);
  return prepared;
}

BakeResult bake(const LoadedMap& map, const BakeSettings& settings, const Context& context) {
  const ContextScope scope(context);
  return bake(prepare_bake(map, settings));
}

BakeResult bake(const PreparedBake& prepared) {
  const auto start = std::chrono::steady_clock::now();
  const double cpu_start = process_cpu_seconds();
  BakeResult result;
  result.settings = prepared.settings;
  result.choice = prepared.choice;
  result.texel_size_m = prepared.map->surface.texel_size_m;
  result.planned_bytes = prepared.plan.memory_bytes();

  LightTransport transport = trace(prepared, result);
  result.energy = energy_of(prepared, transport);
  result.bounces = bounces_of(prepared.settings, transport);
  result.errors = errors_of(prepared, transport, result.bounces);
  result.reached = reached_errors(prepared, transport);
  keep_planes(prepared.map->surface, transport, result);
  crop_bake(prepared.settings.margin, result);
  clear_holes(crop_plane(prepared.map->surface.holes, prepared.settings.margin), result.planes);
  if (prepared.settings.keep_transport) result.transport = std::move(transport);

  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.cpu_seconds = process_cpu_seconds() - cpu_start;
  return result;
}

}  // namespace hemibake
