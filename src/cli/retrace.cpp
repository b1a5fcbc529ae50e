#include "cli/retrace.h"

#include <fmt/format.h>

#include "cli/bake_job.h"
#include "cli/bake_surface.h"
#include "core/constants.h"
#include "core/error.h"
#include "io/links_file.h"

namespace hemibake {
namespace {

// Fills `option` where the bake recorded it: what its tracer does not know is not recorded.
template <class T>
void take(const Provenance& provenance, const char* name, T& option) {
  if (provenance.contains(name)) option = provenance[name].get<T>();
}

}  // namespace

BakeOptions tracing_options_from(const BakeFile& file, const std::filesystem::path& bake_path) {
  const Provenance& p = file.provenance;
  BakeOptions options = map_options_from(p, bake_path);
  try {
    options.tracer = p.at("tracer").get<std::string>();
    options.rays = p.at("rays").get<int>();
    options.cone_degrees = p.at("cone_degrees").get<double>();
    options.seed = p.at("seed").get<uint64_t>();
    options.patch_kind = p.at("patches").get<std::string>();
    if (p.contains("max_distance_m")) options.max_distance_m = p["max_distance_m"].get<double>();
    take(p, "directions", options.directions);
    take(p, "texel_links", options.texel_links);
    take(p, "max_steps", options.max_steps);
    take(p, "lift_percent", options.lift_percent);
    take(p, "ray_set", options.ray_set);
    take(p, "lookup", options.lookup);
    take(p, "normalize", options.normalize);
    take(p, "normal_length", options.normal_length);
  } catch (const nlohmann::json::exception&) {
    throw InputError(bake_path.string() +
                     ": it does not say how it was traced, expected a bake of this version");
  }
  return options;
}

LightTransport retrace(const BakeOptions& options) {
  BakeJob job;
  prepare_bake(options, false, job);
  return trace_surface(*job.tracer, true);
}

LightTransport visibility_from_links(const std::filesystem::path& links_path, const BakeFile& file) {
  LinksFile links = read_links(links_path);
  const Bake& bake = file.bake;
  const auto refuse = [&](const std::string& what) {
    throw InputError(fmt::format("{}: {}, expected the links of this bake", links_path.string(), what));
  };
  const auto input = [](const Provenance& p) {
    return p.is_object() && p.contains("input_sha256") ? p["input_sha256"].dump() : "";
  };
  if (input(links.provenance) != input(file.provenance)) refuse("is of another map");
  const uint64_t texels = static_cast<uint64_t>(bake.width) * static_cast<uint64_t>(bake.height);
  if (links.final_gather.rows != texels)
    refuse(fmt::format("has {} texels, the bake {}", links.final_gather.rows, texels));
  const uint32_t patches =
      links.patch_form_factors ? links.patch_form_factors->rows : links.final_gather.rows;
  if (links.final_gather.columns != patches ||
      (links.patch_form_factors && links.patch_form_factors->columns != patches) ||
      links.direct.size() != patches)
    refuse("its matrices do not fit each other");

  LightTransport seen;
  seen.direct_over_pi = Grid<float>(bake.width, bake.height);
  const std::vector<double> blocked = row_sums(links.final_gather);
  for (size_t i = 0; i < seen.direct_over_pi.size(); ++i)
    seen.direct_over_pi[i] = static_cast<float>(
        bake.irradiance.empty() ? 1 - blocked[i] : static_cast<double>(bake.irradiance[0][i]) / kPi);
  seen.final_gather = std::move(links.final_gather);
  if (!links.patch_form_factors) return seen;
  seen.patch_form_factors = std::move(*links.patch_form_factors);
  for (const float direct : links.direct)
    seen.patch_direct_over_pi.push_back(static_cast<float>(static_cast<double>(direct) / kPi));
  return seen;
}

}  // namespace hemibake
