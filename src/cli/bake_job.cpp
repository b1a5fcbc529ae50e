#include "cli/bake_job.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "core/constants.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/statistics.h"
#include "io/links_file.h"
#include "transport/bounces.h"
#include "transport/direct_light.h"
#include "transport/links/spill_file.h"
#include "transport/trace_surface.h"

namespace hemibake {
namespace {

constexpr double kGib = 1024.0 * 1024 * 1024;
constexpr uint64_t kAnotherSeed = 0x5eed;  // more than the user's
constexpr size_t kTexelsNamed = 5;         // of those that did not converge

PlanOptions plan_options(const BakeJob& job) {
  PlanOptions plan;
  plan.patch_kind = patches_of(job.options);
  plan.with_links = job.options.needs_links();
  plan.bounces = job.options.wants("irradiance") ? job.options.bounces : 0;
  plan.converges = job.options.converge.has_value();
  plan.scene_bytes = tracer_bytes(job.options, job.map.surface);
  if (job.options.wants("normal")) plan.kept_planes += 3;
  if (job.options.wants("irradiance") && !plan.with_links) plan.kept_planes += 3;  // E₀, total, residual
  return plan;
}

double allowed_bytes(const BakeOptions& options) {
  return options.memory_gib ? *options.memory_gib * kGib : static_cast<double>(machine_memory_bytes());
}

void refuse_beyond_memory(const BakeJob& job, const BakePlan& plan) {
  const double allowed = allowed_bytes(job.options);
  if (static_cast<double>(plan.memory_bytes()) <= allowed) return;
  throw InputError(fmt::format("{}: the bake needs {:.3g} GiB, expected at most the {:.3g} GiB of {}",
                               job.options.map.string(), static_cast<double>(plan.memory_bytes()) / kGib,
                               allowed / kGib, job.options.memory_gib ? "--memory" : "this machine"));
}

// Everything that decides the bytes of the result.
Provenance provenance_of(const BakeOptions& options, const Surface& surface) {
  Provenance p = make_provenance(this_command_line(), options.map);
  record_map_options(options, p);
  p["texel_size_m"] = surface.texel_size_m;
  p["tracer"] = options.tracer;
  p["rays"] = options.rays;
  p["cone_degrees"] = options.cone_degrees;
  if (options.max_distance_m) p["max_distance_m"] = *options.max_distance_m;
  p["seed"] = options.seed;
  p["patches"] = options.patch_kind;
  if (options.tracer == "march") {
    p["max_steps"] = options.max_steps;
    p["lift_percent"] = options.lift_percent;
    p["ray_set"] = options.ray_set;
    p["lookup"] = options.lookup;
    p["normalize"] = options.normalize;
    p["normal_length"] = options.normal_length;
  }
  if (options.tracer == "embree") p["directions"] = options.directions;
  if (options.tracer != "march" && options.patch_kind == "texels") p["texel_links"] = options.texel_links;
  p["outputs"] = fmt::format("{}", fmt::join(options.outputs, ","));
  p["bounces"] = options.bounces;
  if (options.converge) {
    p["converge"] = *options.converge;
    p["max_bounces"] = options.max_bounces;
  }
  return p;
}

void record_tracing(const LightTransport& seen, Provenance& p) {
  p["rays_traced"] = seen.counts.rays;
  p["rays_cut_short"] = seen.counts.truncated;
  if (!seen.final_gather.empty()) p["links"] = seen.final_gather.count() + seen.patch_form_factors.count();
}

void record_link_energy(const LinkEnergy& energy, Provenance& p) {
  p["row_sum_error"] = energy.row_sum_error;
  if (!energy.light_over_opening) return;
  p["light_over_opening"] = *energy.light_over_opening;
  p["light_over_opening_stderr"] = energy.light_over_opening_stderr;
}

void record_bounces(const Bounces& bounces, Provenance& p) {
  p["bounces_made"] = bounces.bounces_made;
  p["mean_residual"] = bounces.mean_residual;
  p["worst_residual"] = bounces.worst_residual;
  p["texels_short"] = bounces.unconverged_texels.size();
  p["texels_closed"] = bounces.enclosed_texels.size();
}

void record_errors(const ErrorEstimate& errors, Provenance& p) {
  p["error_ao_rays"] = errors.ao_rays;
  p["error_direct_rays"] = errors.direct_rays;
  p["error_first_rays"] = errors.first_rays;
  p["error_mean_direct_rays"] = errors.mean_direct_rays;
  p["error_mean_first_rays"] = errors.mean_first_rays;
  p["error_mean_first_patches"] = errors.first_patches;
  p["error_mean_half_patches"] = errors.half_patches;
  p["error_mean_total_bounces"] = errors.total_bounces;
  p["error_mean_half_bounces"] = errors.half_bounces;
  p["error_far_horizon"] = errors.far_horizon;
  p["error_curve_direct_rays"] = errors.curve_direct;
  p["error_curve_first_rays"] = errors.curve_first;
}

std::string describe_errors(const ErrorEstimate& e) {
  return fmt::format(
      "errors    of a texel (rms, rays): ao {:.2g}, E0/pi {:.2g}, E1/pi {:.2g}; of the means: E0/pi {:.1g} "
      "rays, E1/pi {:.1g} rays + {:.1g} patches, all at albedo 0.5 {:.1g} patches + {:.1g} bounces, at 1 "
      "{:.1g} "
      "bounces; far horizon {:.1g}; of the curves: E0/pi {:.1g}, E1/pi {:.1g}\n",
      e.ao_rays, e.direct_rays, e.first_rays, e.mean_direct_rays, e.mean_first_rays, e.first_patches,
      e.half_patches, e.half_bounces, e.total_bounces, e.far_horizon, e.curve_direct, e.curve_first);
}

TargetOptions target_options(const BakeJob& job) {
  TargetOptions target;
  target.error = *job.options.target_error;
  target.patch_kind = patches_of(job.options);
  target.with_light = job.options.needs_links() && job.options.wants("irradiance");
  if (job.options.tracer == "embree") target.fewest_rays = 16;
  target.seed = job.options.seed;
  target.make_tracer = [&job](int rays, uint64_t seed) {
    BakeOptions options = job.options;
    options.rays = rays;
    options.seed = seed;
    return make_tracer(options, job.map);
  };
  return target;
}

void choose_rays_and_bounces(BakeJob& job) {
  job.choice = choose_for_target(job.map.surface, target_options(job));
  job.options.rays = job.choice->rays;
  if (job.choice->bounces > 0) job.options.bounces = job.choice->bounces;
}

void record_reached(const BakeOptions& options, const TargetErrors& reached, Provenance& p) {
  p["target_error"] = *options.target_error;
  p["reached_error_ao"] = reached.ao;
  p["reached_error_direct"] = reached.direct;
  for (size_t a = 0; options.wants("irradiance") && a < kTradeAlbedos.size(); ++a)
    p[fmt::format("reached_error_albedo_{:g}", kTradeAlbedos[a])] = reached.light[a];
}

std::string name_texels(const std::vector<uint32_t>& texels, int width) {
  std::string names;
  for (size_t i = 0; i < std::min(texels.size(), kTexelsNamed); ++i)
    names += fmt::format(" {},{}", texels[i] % static_cast<uint32_t>(width),
                         texels[i] / static_cast<uint32_t>(width));
  return names + (texels.size() > kTexelsNamed ? " …" : "");
}

std::vector<std::string> warnings_of(const BakeOptions& options, const LightTransport& seen,
                                     const Bounces& bounces) {
  std::vector<std::string> warnings;
  const int width = seen.direct_over_pi.width;
  if (!bounces.unconverged_texels.empty())
    warnings.push_back(fmt::format("{} texels are short of {:g} after {} bounces, the worst by {:.3g}:{}",
                                   bounces.unconverged_texels.size(), *options.converge, bounces.bounces_made,
                                   bounces.worst_residual, name_texels(bounces.unconverged_texels, width)));
  if (!bounces.enclosed_texels.empty())
    warnings.push_back(fmt::format("{} texels see only themselves and never fill:{}",
                                   bounces.enclosed_texels.size(),
                                   name_texels(bounces.enclosed_texels, width)));
  if (seen.counts.truncated > 0)
    warnings.push_back(
        fmt::format("{} of {} rays were followed to the far limit below the highest texel and taken for sky",
                    seen.counts.truncated, seen.counts.rays));
  return warnings;
}

void store_planes(const BakeOptions& options, const Surface& surface, LightTransport& seen, Bounces& bounces,
                  Bake& bake) {
  bake.width = surface.width();
  bake.height = surface.height();
  if (options.wants("ao")) bake.visible_fraction = std::move(seen.visible_fraction);
  if (options.wants("bent")) bake.bent_normals = std::move(seen.bent_normals);
  if (options.wants("normal")) bake.normals = surface.normals;
  if (options.wants("irradiance")) {
    bake.irradiance = std::move(bounces.irradiance);
    bake.total = std::move(bounces.total);
    bake.residual = std::move(bounces.residual);
  }
}

std::vector<float> irradiance_of(const std::vector<float>& over_pi) {
  std::vector<float> irradiance(over_pi.size());
  for (size_t i = 0; i < over_pi.size(); ++i)
    irradiance[i] = static_cast<float>(kPi * static_cast<double>(over_pi[i]));
  return irradiance;
}

double mean_of(const Grid<float>& plane) { return mean(std::span<const float>(plane.values)); }

}  // namespace

void prepare_bake(const BakeOptions& options, bool only_plan, BakeJob& job) {
  job.options = options;
  job.map = load_bake_map(options);
  // Twice: before the scene is built, which may be too large already, and with the links a pilot finds.
  if (!only_plan) refuse_beyond_memory(job, plan_planes(job.map.surface, plan_options(job)));
  if (options.target_error) choose_rays_and_bounces(job);
  job.tracer = make_tracer(job.options, job.map);
  job.plan = plan_bake(job.map.surface, *job.tracer, plan_options(job));
  job.plan.spills =
      job.plan.link_bytes > 0 && static_cast<double>(job.plan.memory_bytes()) > allowed_bytes(options);
  if (!only_plan) refuse_beyond_memory(job, job.plan);
}

BakeResult perform_bake(const BakeJob& job) {
  const BakeOptions& options = job.options;
  const auto start = std::chrono::steady_clock::now();
  const double cpu_start = process_cpu_seconds();
  BakeResult result;
  result.provenance = provenance_of(options, job.map.surface);

  LightTransport seen =
      trace_surface(*job.tracer, options.needs_links(),
                    job.plan.spills ? std::make_shared<SpillFile>(job.spill_folder) : nullptr);
  result.rays = seen.counts.rays;
  result.trace_cpu_seconds = process_cpu_seconds() - cpu_start;
  record_tracing(seen, result.provenance);
  if (!seen.final_gather.empty()) {
    result.link_energy = measure_link_energy(job.map.surface, job.tracer->patch_set(), seen);
    record_link_energy(*result.link_energy, result.provenance);
  }

  Bounces bounces;
  if (options.wants("irradiance")) {
    bounces = options.needs_links()
                  ? bounce_light(seen, {options.bounces, options.converge, options.max_bounces})
                  : direct_light(seen);
    record_bounces(bounces, result.provenance);
    if (!seen.final_gather.empty() && bounces.irradiance.size() > 1) {
      result.errors = estimate_errors(*job.tracer->reseeded(options.seed + kAnotherSeed), seen, bounces);
      record_errors(*result.errors, result.provenance);
    }
  }
  if (options.target_error) {
    result.reached = measure_reached(job.map.surface, seen, options.bounces, target_options(job));
    record_reached(options, *result.reached, result.provenance);
  }
  if (!options.links.empty())
    write_links(options.links, seen.final_gather,
                seen.patch_form_factors.empty() ? nullptr : &seen.patch_form_factors,
                irradiance_of(seen.patch_direct()), result.provenance);
  result.warnings = warnings_of(options, seen, bounces);
  store_planes(options, job.map.surface, seen, bounces, result.bake);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.cpu_seconds = process_cpu_seconds() - cpu_start;
  return result;
}

std::string describe_bake(const BakeJob& job, const BakeResult& result) {
  const Bake& bake = result.bake;
  const double million_rays = 1e-6 * static_cast<double>(result.rays);
  std::string text = fmt::format("{}: {}x{} texels, {:g} m, amplitude {:g} m, {} edges, {} patches\n",
                                 job.options.map.string(), bake.width, bake.height, job.options.size_m,
                                 job.options.amplitude_m, job.options.edge, job.options.patch_kind);
  text += fmt::format("rays      {:.1f} M in {:.1f} s ({:.1f} cpu-s, {:.2f} Mray/cpu-s)", million_rays,
                      result.seconds, result.cpu_seconds, million_rays / result.trace_cpu_seconds);
  if (result.provenance.contains("links"))
    text += fmt::format(", {:.1f} M links", 1e-6 * result.provenance["links"].get<double>());
  text += fmt::format(", peak memory {:.2f} GiB\n", static_cast<double>(peak_memory_bytes()) / kGib);
  if (job.choice && job.options.explain) text += explain(*job.choice, target_options(job));
  if (result.reached)
    text += fmt::format(
        "reached   rms error {:.5f} of the {:g} wanted, with {} rays{}: AO {:.5f}, E0/pi {:.5f}\n",
        result.reached->worst(), *job.options.target_error, job.options.rays,
        job.choice->bounces > 0 ? fmt::format(" and {} bounces", job.choice->bounces) : "",
        result.reached->ao, result.reached->direct);
  if (!bake.visible_fraction.empty())
    text += fmt::format("ao        mean {:.5f}\n", mean_of(bake.visible_fraction));
  if (!bake.irradiance.empty()) {
    text += fmt::format("E0/pi     mean {:.5f}", mean_of(bake.irradiance[0]) / kPi);
    if (bake.irradiance.size() > 1) text += fmt::format(", E1/pi {:.5f}", mean_of(bake.irradiance[1]) / kPi);
    double half = 0;
    for (size_t b = bake.irradiance.size(); b-- > 0;) half = half / 2 + mean_of(bake.irradiance[b]) / kPi;
    text += fmt::format(", all at albedo 0.5 {:.5f}\n", half);
    text += fmt::format(
        "energy    mean {:.6f} of pi after {} bounces, still under way {:.2g}, in the worst texel {:.2g}\n",
        mean_of(bake.total) / kPi, result.provenance["bounces_made"].get<int>(),
        result.provenance["mean_residual"].get<double>(), result.provenance["worst_residual"].get<double>());
  }
  if (result.errors) text += describe_errors(*result.errors);
  return text;
}

nlohmann::ordered_json json_from_bake(const BakeJob& job, const BakeResult& result) {
  nlohmann::ordered_json json = result.provenance;
  json["width"] = result.bake.width;
  json["height"] = result.bake.height;
  json["seconds"] = result.seconds;
  json["cpu_seconds"] = result.cpu_seconds;
  json["mray_per_cpu_second"] = 1e-6 * static_cast<double>(result.rays) / result.trace_cpu_seconds;
  json["peak_memory_bytes"] = peak_memory_bytes();
  json["planned_memory_bytes"] = job.plan.memory_bytes();
  if (!result.bake.visible_fraction.empty()) json["mean_ao"] = mean_of(result.bake.visible_fraction);
  if (!result.bake.irradiance.empty()) {
    nlohmann::ordered_json means = nlohmann::ordered_json::array();
    for (const auto& plane : result.bake.irradiance) means.push_back(mean_of(plane) / kPi);
    json["mean_irradiance_over_pi"] = means;
    json["mean_total_over_pi"] = mean_of(result.bake.total) / kPi;
  }
  if (job.choice) json["choice"] = json_from_choice(*job.choice);
  json["warnings"] = result.warnings;
  return json;
}

std::string describe_plan(const BakeJob& job) {
  const BakePlan& plan = job.plan;
  const auto gib = [](size_t bytes) { return static_cast<double>(bytes) / kGib; };
  const std::string reasons = job.choice ? explain(*job.choice, target_options(job)) : "";
  return reasons +
         fmt::format(
             "memory    {:.3f} GiB: program {:.3f}, surface and scene {:.3f}, links {:.3f}{}, planes {:.3f}\n"
             "work      {:.1f} M rays, {:.1f} M links, {} bounces: about {:.0f} cpu-s tracing, {:.0f} cpu-s "
             "bouncing\n",
             gib(plan.memory_bytes()), gib(BakePlan::kProgramBytes), gib(plan.surface_bytes),
             gib(plan.link_bytes), plan.spills ? " (in a temporary file)" : "", gib(plan.plane_bytes),
             1e-6 * static_cast<double>(plan.rays), 1e-6 * static_cast<double>(plan.links),
             job.options.bounces, plan.trace_cpu_seconds, plan.bounce_cpu_seconds);
}

nlohmann::ordered_json json_from_plan(const BakeJob& job) {
  const BakePlan& plan = job.plan;
  return {{"memory_bytes", plan.memory_bytes()},
          {"memory_gib", static_cast<double>(plan.memory_bytes()) / kGib},
          {"surface_bytes", plan.surface_bytes},
          {"link_bytes", plan.link_bytes},
          {"links_spilled", plan.spills},
          {"plane_bytes", plan.plane_bytes},
          {"rays", plan.rays},
          {"links", plan.links},
          {"trace_cpu_seconds", plan.trace_cpu_seconds},
          {"bounce_cpu_seconds", plan.bounce_cpu_seconds}};
}

}  // namespace hemibake
