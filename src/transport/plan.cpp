#include "transport/plan.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/statistics.h"
#include "sampling/low_discrepancy.h"
#include "transport/links.h"

namespace hemibake {
namespace {

constexpr uint32_t kPilotRows = 512;
constexpr uint64_t kPilotStream = 100;
// Seconds a link takes in a bounce: measured 1–2 ns where the light under way fits the cache.
constexpr double kSecondsPerLink = 2e-9;

struct Pilot {
  Moments links;              // of a row
  double bytes_per_link = 0;  // all in
  uint64_t rays = 0;
  double cpu_seconds = 0;
};

// Rows spread over [0, count), one at random in each of equal strata (a fixed step would meet the same
// columns of the map again and again), traced on this thread.
template <class TraceRow>
Pilot trace_pilot(uint32_t count, uint32_t columns, const TraceRow& trace_row) {
  Pilot pilot;
  Row row;
  TracerCounts counts;
  const uint32_t rows = std::min(count, kPilotRows);
  Links links = make_links(rows, columns);
  const double start = process_cpu_seconds();
  for (uint32_t i = 0; i < rows; ++i) {
    const double place = (i + unit_interval(mix_bits(0, kPilotStream, i))) / rows;
    const uint32_t receiver = std::min(count - 1, static_cast<uint32_t>(place * count));
    trace_row(receiver, row, counts);
    append_row(links.blocks[i / Links::kRowsPerBlock], row.links);
    pilot.links.add(static_cast<double>(row.links.size()));
  }
  finish_blocks(links);
  if (pilot.links.mean > 0)
    pilot.bytes_per_link = static_cast<double>(links.stored_bytes()) / (pilot.links.mean * rows);
  pilot.cpu_seconds = process_cpu_seconds() - start;
  pilot.rays = counts.rays;
  return pilot;
}

void add_pilot(const Pilot& pilot, uint32_t count, BakePlan& plan) {
  const double rows = static_cast<double>(pilot.links.count), scale = count / rows;
  const double error = 4 * pilot.links.stddev() / std::sqrt(rows);
  plan.rays += static_cast<uint64_t>(std::llround(static_cast<double>(pilot.rays) * scale));
  plan.links += static_cast<uint64_t>(std::llround(pilot.links.mean * count));
  plan.link_bytes += static_cast<size_t>((pilot.links.mean + error) * pilot.bytes_per_link * count);
  // Blocks being made, one per thread: the rows as traced, collected, and as numbers on their way.
  constexpr size_t kBytesPerOpenLink = 40;
  plan.plane_bytes += static_cast<size_t>(thread_count()) * Links::kRowsPerBlock * kBytesPerOpenLink *
                      static_cast<size_t>(pilot.links.mean + 4 * pilot.links.stddev());
  plan.trace_cpu_seconds += pilot.cpu_seconds * scale;
}

}  // namespace

BakePlan plan_planes(const Surface& surface, const PlanOptions& options) {
  const size_t texels = surface.texel_count();
  BakePlan plan;
  plan.surface_bytes = texels * 16 + options.scene_bytes;
  // α, E₀/π and the bent normal; then every bounce, total and residual as planes; under way, four vectors of
  // doubles for texels; for patches their direct light, a copy of the light in float, and three vectors of
  // doubles twice, in the bounces and in the estimate of errors: the allocator keeps the first three.
  plan.plane_bytes = texels * (20 + 4 * static_cast<size_t>(options.kept_planes));
  if (options.with_links) {
    const size_t patches = make_patches(surface, options.patches).count;
    plan.plane_bytes += texels * (4 * static_cast<size_t>(options.bounces + 3) + 32) + patches * 56;
    // Light and residual of the solver, and the four directions it keeps.
    if (options.converges) plan.plane_bytes += texels * 8 + patches * 8 * (2 + 2 * 4);
  }
  return plan;
}

BakePlan plan_bake(const Surface& surface, const Tracer& tracer, const PlanOptions& options) {
  BakePlan plan = plan_planes(surface, options);
  const auto of_texels = [&](uint32_t texel, Row& row, TracerCounts& counts) {
    tracer.trace_texel(texel, options.with_links, row, counts);
  };
  add_pilot(trace_pilot(surface.texel_count(), tracer.patches().count, of_texels), surface.texel_count(),
            plan);
  if (options.with_links && options.patches == Patches::kFacets) {
    const auto of_patches = [&](uint32_t patch, Row& row, TracerCounts& counts) {
      tracer.trace_patch(patch, true, row, counts);
    };
    add_pilot(trace_pilot(tracer.patches().count, tracer.patches().count, of_patches), tracer.patches().count,
              plan);
  }
  if (!options.with_links) plan.link_bytes = 0;
  plan.bounce_cpu_seconds = static_cast<double>(plan.links) * options.bounces * kSecondsPerLink;
  return plan;
}

size_t machine_memory_bytes() {
  return static_cast<size_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<size_t>(sysconf(_SC_PAGE_SIZE));
}

}  // namespace hemibake
