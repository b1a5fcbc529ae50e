// The bake: from a surface to the light on it. Everything that bakes calls this one function.
#pragma once

#include <optional>

#include "bake/energy.h"
#include "bake/error_estimate.h"
#include "bake/load.h"
#include "bake/plan.h"
#include "bake/target_error.h"
#include "core/context.h"
#include "tracers/tracer.h"
#include "transport/baked_planes.h"
#include "transport/bounces.h"
#include "transport/trace_surface.h"

namespace hemibake {

// A bake made ready: its settings final, its tracer built, its memory known. `tracer` refers to the map,
// which must outlive it.
struct PreparedBake {
  const LoadedMap* map = nullptr;
  BakeSettings settings;
  std::optional<TargetChoice> choice;  // where settings.target_error chose rays and bounces
  std::unique_ptr<Tracer> tracer;
  BakePlan plan;  // empty where settings.limit_memory is off
};

struct BakeResult {
  BakeSettings settings;  // as baked: resolved, with the rays and bounces that a target error chose
  double texel_size_m = 0;
  Bake planes;
  TracerCounts counts;
  uint64_t links = 0;                   // form factors traced
  std::optional<Bounces> bounces;       // where irradiance was baked; its planes have moved to `planes`
  std::optional<LinkEnergy> energy;     // where there were form factors
  std::optional<ErrorEstimate> errors;  // where there were form factors and a bounce
  std::optional<TargetChoice> choice;
  std::optional<TargetErrors> reached;      // with a target error
  std::optional<LightTransport> transport;  // where settings.keep_transport
  size_t planned_bytes = 0;
  double seconds = 0, cpu_seconds = 0, trace_cpu_seconds = 0;
};

// Returns the bytes, beside the program's, that the plan of a bake comes to at least.
// width, height: texels of the file; settings: resolved.
double least_bake_bytes(int width, int height, const MapSettings& map, const BakeSettings& settings);

enum class MemoryLimit { kEnforced, kPlannedOnly };

// Chooses what a target error leaves open, builds the tracer and plans the memory. settings: resolved. Throws
// InputError where the bake needs more memory than allowed even with its form factors in a file (only where
// the limit is enforced).
PreparedBake prepare_bake(const LoadedMap& map, const BakeSettings& settings,
                          MemoryLimit limit = MemoryLimit::kEnforced);

// Traces, bounces, and measures energy and errors. settings: resolved. Throws InputError as prepare_bake, and
// Cancelled.
BakeResult bake(const LoadedMap& map, const BakeSettings& settings, const Context& context);
BakeResult bake(const PreparedBake& prepared);

}  // namespace hemibake
