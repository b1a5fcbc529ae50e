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

// Receivers are traced as tracers answer them together: groups of texels, whole runs of patches.
constexpr uint32_t kTexelGroups = 64, kTexelsOfGroup = 16, kPatchGroups = 96;
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

// Neighbouring rows.
struct RowGroup {
  uint32_t first, count;
};

// Traces groups of rows on this thread. columns: of the matrix. trace_rows(first, rows, counts) as
// Tracer::trace_texels.
template <class TraceRows>
Pilot trace_pilot(std::span<const RowGroup> groups, uint32_t columns, const TraceRows& trace_rows) {
  Pilot pilot;
  for (const RowGroup& group : groups) pilot.rows += group.count;
  FormFactorMatrix links = make_form_factors(pilot.rows, columns);
  TracerCounts counts;
  std::vector<Row> rows;
  uint32_t next_row = 0;
  uint64_t traced_links = 0;
  const double start = process_cpu_seconds();
  for (const RowGroup& group : groups) {
    rows.resize(std::max<size_t>(rows.size(), group.count));
    const std::span<Row> of_group(rows.data(), group.count);
    trace_rows(group.first, of_group, counts);
    uint64_t links_of_group = 0;
    for (const Row& row : of_group) {
      append_row(links.blocks[next_row++ / FormFactorMatrix::kRowsPerBlock], row.links);
      links_of_group += row.links.size();
    }
    traced_links += links_of_group;
    pilot.links.add(static_cast<double>(links_of_group) / group.count);
  }
  finish_blocks(links);
  if (traced_links > 0)
    pilot.bytes_per_link = static_cast<double>(links.stored_bytes()) / static_cast<double>(traced_links);
  pilot.cpu_seconds = process_cpu_seconds() - start;
  pilot.rays = counts.rays;
  return pilot;
}

// Returns groups spread over `count` texels.
std::vector<RowGroup> texel_groups(uint32_t count) {
  std::vector<RowGroup> groups;
  for (const uint32_t group :
       stratified_sample((count + kTexelsOfGroup - 1) / kTexelsOfGroup, kTexelGroups, kPilotStream)) {
    const uint32_t first = group * kTexelsOfGroup;
    groups.push_back({first, std::min(kTexelsOfGroup, count - first)});
  }
  return groups;
}

// Returns runs spread over the patches.
std::vector<RowGroup> patch_groups(const PatchSet& patches) {
  std::vector<RowGroup> groups;
  const auto runs = static_cast<uint32_t>(patches.runs.size() - 1);
  for (const uint32_t run : stratified_sample(runs, kPatchGroups, kPilotStream))
    if (const uint32_t count = patches.runs[run + 1].first - patches.runs[run].first; count > 0)
      groups.push_back({patches.runs[run].first, count});
  return groups;
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
  const PatchSet& patch_set = tracer.patch_set();
  add_pilot(trace_pilot(texel_groups(surface.texel_count()), patch_set.count, of_texels),
            surface.texel_count(), plan);
  if (options.with_links && options.patch_kind == PatchKind::kFacets && patch_set.count > 0) {
    const auto of_patches = [&](uint32_t first, std::span<Row> rows, TracerCounts& counts) {
      tracer.trace_patches(first, true, rows, counts);
    };
    add_pilot(trace_pilot(patch_groups(patch_set), patch_set.count, of_patches), patch_set.count, plan);
  }
  if (!options.with_links) plan.link_bytes = 0;
  plan.bounce_cpu_seconds = static_cast<double>(plan.links) * options.bounces * kSecondsPerLink;
  return plan;
}

}  // namespace hemibake
