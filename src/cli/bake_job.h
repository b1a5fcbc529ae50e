// A bake from options to planes: what `bake` and `run` share.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "bake/energy.h"
#include "bake/error_estimate.h"
#include "bake/plan.h"
#include "bake/target_error.h"
#include "cli/bake_options.h"
#include "cli/bake_surface.h"
#include "io/provenance.h"
#include "tracers/tracer.h"
#include "transport/baked_planes.h"

namespace hemibake {

// The map, read and made ready. `tracer` refers to `map`: a job stays where it is.
struct BakeJob {
  BakeOptions options;
  BakeMap map;
  std::unique_ptr<Tracer> tracer;
  BakePlan plan;
  std::optional<TargetChoice> choice;  // with --target-error; `options` hold what it chose
  std::filesystem::path spill_folder;  // for links that --memory does not hold; empty: the current one

  BakeJob() = default;
  BakeJob(const BakeJob&) = delete;
  BakeJob& operator=(const BakeJob&) = delete;
};

// Reads the map and the normal map, builds the tracer and plans the bake. Throws InputError where the input
// cannot be used, or where the bake needs more memory than allowed even if its links are spilled (not with
// `only_plan`).
void prepare_bake(const BakeOptions& options, bool only_plan, BakeJob& job);

struct BakeResult {
  Bake bake;
  Provenance provenance;
  std::optional<LinkEnergy> link_energy;
  std::optional<ErrorEstimate> errors;  // with links and a bounce
  std::optional<TargetErrors> reached;  // with --target-error
  // For the person at the terminal.
  uint64_t rays = 0;
  double seconds = 0, cpu_seconds = 0, trace_cpu_seconds = 0;
  std::vector<std::string> warnings;  // texels left short and the like
};

// Traces, bounces, and writes the links file where asked.
BakeResult perform_bake(const BakeJob& job);

// The closing summary.
std::string describe_bake(const BakeJob& job, const BakeResult& result);
nlohmann::ordered_json json_from_bake(const BakeJob& job, const BakeResult& result);
std::string describe_plan(const BakeJob& job);
nlohmann::ordered_json json_from_plan(const BakeJob& job);

}  // namespace hemibake
