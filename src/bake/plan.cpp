#include "bake/plan.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "core/parallel.h"
#include "core/statistics.h"
#include "sampling/strata.h"
#include "transport/links/form_factors.h"

namespace hemibake {
namespace {

// Neighbouring patches are the same node of one run: more groups, to know how many facets are cut finely.
constexpr uint32_t kTexelGroups = 64, kPatchGroups = 512, kGroupRows = 16;
constexpr uint64_t kPilotStream = 100;
// Seconds a link takes in a bounce: measured 1–2 ns where the light under way fits the cache.
constexpr double kSecondsPerLink = 2e-9;

struct Pilot {
  Moments links;  // of a row, mean over a group
  uint32_t rows = 0;
  double bytes_per_link = 0;  // all in
  uint64_t rays = 0;
  double cpu_seconds = 0;
};

// Groups of kGroupRows neighbours, which a tracer may answer together, spread over [0, count), traced on this
// thread. trace_rows(first, rows, counts) as Tracer::trace_texels.
template <class TraceRows>
Pilot trace_pilot(uint32_t count, uint32_t columns, uint32_t most_groups, const TraceRows& trace_rows) {
  Pilot pilot;
  TracerCounts counts;
  std::vector<Row> rows(std::min(count, kGroupRows));
  const uint32_t groups = (count + kGroupRows - 1) / kGroupRows;
  std::vector<uint32_t> firsts = stratified_sample(groups, most_groups, kPilotStream);
  for (uint32_t& first : firsts) {
    first *= kGroupRows;
    pilot.rows += std::min(kGroupRows, count - first);
  }
  FormFactorMatrix links = make_form_factors(pilot.rows, columns);
  uint32_t next_row = 0;
  uint64_t traced_links = 0;
  const double start = process_cpu_seconds();
  for (const uint32_t first : firsts) {
    const std::span<Row> group(rows.data(), std::min(kGroupRows, count - first));
    trace_rows(first, group, counts);
    uint64_t make_block_jacobi = 0;
    for (const Row& row : group) {
      append_row(links.blocks[next_row++ / FormFactorMatrix::kRowsPerBlock], row.links);
      make_block_jacobi += row.links.size();
    }
    traced_links += make_block_jacobi;
    pilot.links.add(static_cast<double>(make_block_jacobi) / static_cast<double>(group.size()));
  }
  finish_blocks(links);
  if (traced_links > 0)
    pilot.bytes_per_link = static_cast<double>(links.stored_bytes()) / static_cast<double>(traced_links);
  pilot.cpu_seconds = process_cpu_seconds() - start;
  pilot.rays = counts.rays;
  return pilot;
}

void add_pilot(const Pilot& pilot, uint32_t count, BakePlan& plan) {
  const double scale = static_cast<double>(count) / pilot.rows;
  const double error = 4 * pilot.links.stddev() / std::sqrt(static_cast<double>(pilot.links.count));
  plan.rays += static_cast<uint64_t>(std::llround(static_cast<double>(pilot.rays) * scale));
  plan.links += static_cast<uint64_t>(std::llround(pilot.links.mean * count));
  plan.link_bytes += static_cast<size_t>((pilot.links.mean + error) * pilot.bytes_per_link * count);
  // Blocks being made, one per thread: the rows as traced, collected, and as numbers on their way.
  constexpr size_t kBytesPerOpenLink = 40;
  plan.plane_bytes += static_cast<size_t>(thread_count()) * FormFactorMatrix::kRowsPerBlock *
                      kBytesPerOpenLink * static_cast<size_t>(pilot.links.mean + 4 * pilot.links.stddev());
  plan.trace_cpu_seconds += pilot.cpu_seconds * scale;
}

}  // namespace

BakePlan plan_planes(size_t texels, size_t patches, const PlanOptions& options) {
  BakePlan plan;
  plan.surface_bytes = texels * 16 + options.scene_bytes;
  // α, E₀/π and the bent normal; then every bounce, total and residual as planes; under way, four vectors of
  // doubles for texels; for patches their direct light, a copy of the light in float, four vectors of doubles
  // in the bounces and three in the estimate of errors: the allocator keeps the former.
  plan.plane_bytes = texels * (20 + 4 * static_cast<size_t>(options.kept_planes));
  if (options.with_links) {
    plan.plane_bytes += texels * (4 * static_cast<size_t>(options.bounces + 5) + 32) + patches * 64;
    // Light and residual of the solver, the four directions it keeps, and at most 32 bytes for its groups.
    if (options.converges) plan.plane_bytes += texels * 8 + patches * (8 * (2 + 2 * 4) + 32);
  }
  return plan;
}

BakePlan plan_planes(const Surface& surface, const PlanOptions& options) {
  return plan_planes(surface.texel_count(),
                     options.with_links ? make_patches(surface, options.patch_kind).count : 0, options);
}

BakePlan plan_bake(const Surface& surface, const Tracer& tracer, const PlanOptions& options) {
  BakePlan plan = plan_planes(surface, options);
  const auto of_texels = [&](uint32_t first, std::span<Row> rows, TracerCounts& counts) {
    tracer.trace_texels(first, options.with_links, rows, counts);
  };
  add_pilot(trace_pilot(surface.texel_count(), tracer.patch_set().count, kTexelGroups, of_texels),
            surface.texel_count(), plan);
  if (options.with_links && options.patch_kind == PatchKind::kFacets) {
    const auto of_patches = [&](uint32_t first, std::span<Row> rows, TracerCounts& counts) {
      tracer.trace_patches(first, true, rows, counts);
    };
    add_pilot(trace_pilot(tracer.patch_set().count, tracer.patch_set().count, kPatchGroups, of_patches),
              tracer.patch_set().count, plan);
  }
  if (!options.with_links) plan.link_bytes = 0;
  plan.bounce_cpu_seconds = static_cast<double>(plan.links) * options.bounces * kSecondsPerLink;
  return plan;
}

}  // namespace hemibake
