#include "cli/print/bake.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <nlohmann/json.hpp>

#include "cli/print/map.h"
#include "core/constants.h"
#include "core/parallel.h"
#include "core/statistics.h"

namespace hemibake {
namespace {

constexpr double kGib = 1024.0 * 1024 * 1024;
constexpr size_t kTexelsNamed = 5;  // of those that did not converge

double mean_of(const Grid<float>& plane) { return mean(std::span<const float>(plane.values)); }

std::string describe_errors(const ErrorEstimate& e) {
  return fmt::format(
      "errors    of a texel (rms, rays): ao {:.2g}, E0/pi {:.2g}, E1/pi {:.2g}; of the means: E0/pi {:.1g} "
      "rays, E1/pi {:.1g} rays + {:.1g} patches, all at albedo 0.5 {:.1g} patches + {:.1g} bounces, at 1 "
      "{:.1g} "
      "bounces; far horizon {:.1g}; of the curves: E0/pi {:.1g}, E1/pi {:.1g}\n",
      e.ao_rays, e.direct_rays, e.first_rays, e.mean_direct_rays, e.mean_first_rays, e.first_patches,
      e.half_patches, e.half_bounces, e.total_bounces, e.far_horizon, e.curve_direct, e.curve_first);
}

std::string name_texels(const std::vector<uint32_t>& texels, int width) {
  std::string names;
  for (size_t i = 0; i < std::min(texels.size(), kTexelsNamed); ++i)
    names += fmt::format(" {},{}", texels[i] % static_cast<uint32_t>(width),
                         texels[i] / static_cast<uint32_t>(width));
  return names + (texels.size() > kTexelsNamed ? " …" : "");
}

std::string describe_choice(const TargetChoice& choice) {
  std::string text = fmt::format(
      "target    rms error of AO, E0/pi{} at most {:g}\n"
      "pilot     {} texels in blocks of {}, against slices with {} azimuths ({:.2f} cpu-s)\n",
      choice.with_light ? " and E/pi at albedo 0.2 to 0.95" : "", choice.error, choice.sampled_texels,
      kSampleBlockTexels, choice.reference_azimuths, choice.pilot_cpu_seconds);
  for (const PilotRung& rung : choice.pilot) {
    text += fmt::format("          {:5} rays: AO {:.5f}, E0/pi {:.5f}", rung.rays, rung.error.ao,
                        rung.error.direct);
    for (size_t a = 0; choice.with_light && a < kJudgedAlbedos.size(); ++a)
      text +=
          fmt::format("{}{:g} {:.5f}", a == 0 ? ", E/pi at " : ", ", kJudgedAlbedos[a], rung.error.light[a]);
    text += "\n";
  }
  if (choice.with_light)
    text += fmt::format(
        "bounces   {}: later ones would add {:.5f} rms at albedo {:g}, at most a quarter of the target\n",
        choice.bounces, choice.truncation, kJudgedAlbedos.back());
  text +=
      fmt::format("rays      {}: {}\n", choice.rays,
                  !choice.reachable         ? "the most there may be, and not enough"
                  : choice.pilot.size() < 2 ? "the fewest there are, and enough"
                                            : "where the power law between the last two reaches the target");
  return text;
}

nlohmann::ordered_json json_from_choice(const TargetChoice& choice) {
  nlohmann::ordered_json json = {{"rays", choice.rays},
                                 {"bounces", choice.bounces},
                                 {"reachable", choice.reachable},
                                 {"sampled_texels", choice.sampled_texels},
                                 {"reference_azimuths", choice.reference_azimuths},
                                 {"truncation", choice.truncation},
                                 {"pilot_cpu_seconds", choice.pilot_cpu_seconds},
                                 {"pilot", nlohmann::ordered_json::array()}};
  for (const PilotRung& rung : choice.pilot)
    json["pilot"].push_back({{"rays", rung.rays},
                             {"ao", rung.error.ao},
                             {"direct", rung.error.direct},
                             {"light", rung.error.light}});
  return json;
}

}  // namespace

std::vector<std::string> warnings_of(const BakeResult& result) {
  std::vector<std::string> warnings;
  const int width = result.planes.width;
  const Bounces bounces = result.bounces.value_or(Bounces{});
  if (!bounces.unconverged_texels.empty())
    warnings.push_back(fmt::format("{} texels are short of {:g} after {} bounces, the worst by {:.3g}:{}",
                                   bounces.unconverged_texels.size(), *result.settings.converge,
                                   bounces.bounces_made, bounces.worst_residual,
                                   name_texels(bounces.unconverged_texels, width)));
  if (!bounces.enclosed_texels.empty())
    warnings.push_back(fmt::format("{} texels see only themselves and never fill:{}",
                                   bounces.enclosed_texels.size(),
                                   name_texels(bounces.enclosed_texels, width)));
  if (result.counts.truncated > 0)
    warnings.push_back(
        fmt::format("{} of {} rays were followed to the far limit below the highest texel and taken for sky",
                    result.counts.truncated, result.counts.rays));
  return warnings;
}

std::string line_of_bake(const MapSettings& map, const BakeResult& result,
                         const std::filesystem::path& output) {
  const Bake& bake = result.planes;
  std::string text = fmt::format("{}: {}x{}", map.map.string(), bake.width, bake.height);
  if (!bake.visible_fraction.empty()) text += fmt::format(", alpha {:.4f}", mean_of(bake.visible_fraction));
  if (!bake.visibility.empty()) text += fmt::format(", V {:.4f}", mean_of(bake.visibility));
  if (bake.irradiance.size() > 1) text += fmt::format(", E1/pi {:.4f}", mean_of(bake.irradiance[1]) / kPi);
  return text + fmt::format(", {:.1f} s: {}", result.seconds, output.string());
}

std::string describe_bake(const LoadedMap& map, const BakeResult& result) {
  const Bake& bake = result.planes;
  const MapSettings& settings = map.settings;
  const double million_rays = 1e-6 * static_cast<double>(result.counts.rays);
  std::string text = fmt::format("{}: {}x{} texels, {:g} m, {}, {} patches\n", settings.map.string(),
                                 bake.width, bake.height, *settings.size_m,
                                 settings.heights == HeightUnit::kMetres
                                     ? "heights in metres"
                                     : fmt::format("amplitude {:g} m", *settings.amplitude_m),
                                 result.settings.patch_kind == PatchKind::kFacets ? "facets" : "texels");
  text += describe_map(map);
  text += fmt::format("rays      {:.1f} M in {:.1f} s ({:.1f} cpu-s, {:.2f} Mray/cpu-s)", million_rays,
                      result.seconds, result.cpu_seconds, million_rays / result.trace_cpu_seconds);
  if (result.energy) text += fmt::format(", {:.1f} M links", 1e-6 * static_cast<double>(result.links));
  text += fmt::format(", peak memory {:.2f} GiB\n", static_cast<double>(peak_memory_bytes()) / kGib);
  if (result.choice && result.settings.explain) text += describe_choice(*result.choice);
  if (result.reached)
    text += fmt::format(
        "reached   rms error {:.5f} of the {:g} wanted, with {} rays{}: AO {:.5f}, E0/pi {:.5f}\n",
        result.reached->worst(), *result.settings.target_error, *result.settings.rays,
        result.choice->bounces > 0 ? fmt::format(" and {} bounces", result.choice->bounces) : "",
        result.reached->ao, result.reached->direct);
  if (!bake.visible_fraction.empty())
    text += fmt::format("ao        mean {:.5f} (alpha: every direction of the sky counts the same)\n",
                        mean_of(bake.visible_fraction));
  if (!bake.visibility.empty())
    text += fmt::format("visible   mean {:.5f} (V = E0/pi: weighted by the cosine, the AO of engines)\n",
                        mean_of(bake.visibility));
  if (!bake.irradiance.empty()) {
    text += fmt::format("E0/pi     mean {:.5f}", mean_of(bake.irradiance[0]) / kPi);
    if (bake.irradiance.size() > 1) text += fmt::format(", E1/pi {:.5f}", mean_of(bake.irradiance[1]) / kPi);
    double half = 0;
    for (size_t b = bake.irradiance.size(); b-- > 0;) half = half / 2 + mean_of(bake.irradiance[b]) / kPi;
    text += fmt::format(", all at albedo 0.5 {:.5f}\n", half);
    text += fmt::format(
        "energy    mean {:.6f} of pi after {} bounces, still under way {:.2g}, in the worst texel {:.2g}\n",
        mean_of(bake.total) / kPi, result.bounces->bounces_made, result.bounces->mean_residual,
        result.bounces->worst_residual);
  }
  if (result.errors) text += describe_errors(*result.errors);
  return text;
}

nlohmann::ordered_json json_from_bake(const LoadedMap& map, const BakeResult& result,
                                      const Provenance& provenance) {
  nlohmann::ordered_json json = provenance;
  json["map"] = json_from_map(map);
  json["width"] = result.planes.width;
  json["height"] = result.planes.height;
  json["seconds"] = result.seconds;
  json["cpu_seconds"] = result.cpu_seconds;
  json["mray_per_cpu_second"] = 1e-6 * static_cast<double>(result.counts.rays) / result.trace_cpu_seconds;
  json["peak_memory_bytes"] = peak_memory_bytes();
  json["planned_memory_bytes"] = result.planned_bytes;
  if (!result.planes.visible_fraction.empty()) json["mean_ao"] = mean_of(result.planes.visible_fraction);
  if (!result.planes.visibility.empty()) json["mean_visibility"] = mean_of(result.planes.visibility);
  if (!result.planes.irradiance.empty()) {
    nlohmann::ordered_json means = nlohmann::ordered_json::array();
    for (const auto& plane : result.planes.irradiance) means.push_back(mean_of(plane) / kPi);
    json["mean_irradiance_over_pi"] = means;
    json["mean_total_over_pi"] = mean_of(result.planes.total) / kPi;
  }
  if (result.choice) json["choice"] = json_from_choice(*result.choice);
  std::vector<std::string> warnings = warnings_of(map);
  std::ranges::copy(warnings_of(result), std::back_inserter(warnings));
  json["warnings"] = warnings;
  return json;
}

std::string describe_plan(const PreparedBake& prepared) {
  const BakePlan& plan = prepared.plan;
  const auto gib = [](size_t bytes) { return static_cast<double>(bytes) / kGib; };
  const std::string reasons = prepared.choice ? describe_choice(*prepared.choice) : "";
  return reasons +
         fmt::format(
             "memory    {:.3f} GiB: program {:.3f}, surface and scene {:.3f}, links {:.3f}{}, planes {:.3f}\n"
             "work      {:.1f} M rays, {:.1f} M links, {} bounces: about {:.0f} cpu-s tracing, {:.0f} cpu-s "
             "bouncing\n",
             gib(plan.memory_bytes()), gib(BakePlan::kProgramBytes), gib(plan.surface_bytes),
             gib(plan.link_bytes), plan.spills ? " (in a temporary file)" : "", gib(plan.plane_bytes),
             1e-6 * static_cast<double>(plan.rays), 1e-6 * static_cast<double>(plan.links),
             prepared.settings.bounces, plan.trace_cpu_seconds, plan.bounce_cpu_seconds);
}

nlohmann::ordered_json json_from_plan(const BakePlan& plan) {
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
