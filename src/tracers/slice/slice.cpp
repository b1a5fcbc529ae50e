#include "tracers/slice/slice.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/parallel.h"
#include "sampling/low_discrepancy.h"
#include "surface/facets.h"
#include "tracers/hit_form_factors.h"
#include "tracers/slice/families.h"
#include "tracers/slice/height_pyramid.h"
#include "tracers/slice/intervals.h"
#include "tracers/slice/replay.h"
#include "tracers/slice/traversal.h"

namespace hemibake {
namespace {

// Hash streams, one per use, apart from those of the other tracers.
constexpr uint64_t kTexelRotation = 0x511ce01, kNodeRotation = 0x511ce03, kTexelHitOffset = 0x511ce04,
                   kNodeHitOffset = 0x511ce05, kTexelSample = 0x511ce06, kNodeSample = 0x511ce07;

// Hits of a slice that holds the mean share of its receiver's hemisphere. Nodes take fewer: a texel gathers
// from many of them.
constexpr double kTexelHits = kHitsPerSlice, kNodeHits = 1.5;

// Packets traced together: with form factors, their hits stay in the cache; without, more of them follow the
// same path.
constexpr size_t kNodePacketsTogether = 64, kTexelPacketsTogether = 1024, kTexelPacketsWithLinks = 16;

// Share of the light; a smaller blocked one counts as none: a tenth of a horizon's error.
constexpr double kLeastBlocked = 1e-5;
// Hits wanted of a receiver that would have none.
constexpr double kFewestHits = 8;

static_assert(kSliceLanes == kRunCells);

// The receivers of one packet whose rows are wanted.
struct PacketQuery {
  SlicePacket packet;
  uint32_t lanes;        // bits of the wanted ones
  uint32_t receiver;     // of the first of them; the next one's is one more
  uint32_t first_facet;  // of lane 0, where the receivers are nodes; the next lane's is two more
};

// Destination of the rows of a family's receivers.
struct RowTarget {
  const SlicePaths& paths;
  bool with_links;
  std::span<Row> rows;
  uint32_t first;                                   // receiver of rows[0]
  uint32_t map_width = 0xffffffff, tile_width = 0;  // of a tile's rows; default: one receiver after the other

  Row& row(uint32_t receiver) const {
    const uint32_t number = receiver - first;
    return rows[size_t{number / map_width} * tile_width + number % map_width];
  }
};

// Returns the lowest `count` of the set bits, or all of them.
uint32_t first_bits(uint32_t bits, uint32_t count) {
  uint32_t others = bits;
  for (; count > 0 && others != 0; --count) others &= others - 1;
  return bits & ~others;
}

// Fills sky and direct light of a lane's row.
void fill_sky(const SlicePacket& packet, const PacketView& view, size_t lane, Row& row) {
  const glm::dvec3 sky(view.sky.x[lane], view.sky.y[lane], view.sky.z[lane]);
  // Over the unblocked hemisphere along the same azimuths: exactly 1 on open ground.
  row.visible_fraction = std::clamp(view.sky.uniform[lane] / view.hemisphere.uniform[lane], 0.0, 1.0);
  row.direct_over_pi =
      std::clamp(cosine_sum(packet, view.sky, lane) / cosine_sum(packet, view.hemisphere, lane), 0.0, 1.0);
  const double length = glm::length(sky);
  row.bent_normal =
      length > 0
          ? sky / length
          : glm::normalize(glm::dvec3(-packet.tangent_slope_x[lane], -packet.tangent_slope_y[lane], 1));
}

class SliceTracer final : public Tracer {
 public:
  SliceTracer(const Surface& surface, const SliceOptions& options);

  const Surface& surface() const override { return surface_; }
  const PatchSet& patch_set() const override { return patch_set_; }
  void trace_texel(uint32_t texel, bool with_links, Row& row, TracerCounts& counts) const override {
    trace_texels(texel, with_links, {&row, 1}, counts);
  }
  void trace_patch(uint32_t patch, bool with_links, Row& row, TracerCounts& counts) const override {
    trace_patches(patch, with_links, {&row, 1}, counts);
  }
  void trace_texels(uint32_t first, bool with_links, std::span<Row> rows,
                    TracerCounts& counts) const override;
  void trace_tile(const TexelTile& tile, std::span<Row> rows, TracerCounts& counts) const override;
  void trace_patches(uint32_t first, bool with_links, std::span<Row> rows,
                     TracerCounts& counts) const override;
  std::unique_ptr<Tracer> reseeded(uint64_t seed) const override {
    auto again = std::make_unique<SliceTracer>(*this);
    again->options_.seed = seed;
    again->families_ = make_slice_families(options_.azimuths, options_.patch_kind, seed);
    return again;
  }
  std::vector<RayRecord> replay_texel(uint32_t texel) const override;

 private:
  int draw_rotation(const SlicePaths& paths, uint64_t stream, uint64_t index) const;
  void set_hit_sampling(double per_slice, uint64_t stream, uint64_t index, SlicePacket& packet) const;
  SlicePacket texel_packet(int x, int y) const;
  SlicePacket node_packet(const NodeGroup& group) const;
  std::span<const PacketView> trace_packets(const SlicePaths& paths, Query query,
                                            std::span<const SlicePacket> packets) const;
  void resample_missed_hits(const SlicePaths& paths, const SlicePacket& packet, PacketView& view) const;
  void clip_to_max_distance(const SlicePaths& paths, const SlicePacket& packet, PacketView& view) const;
  void add_texel_queries(uint32_t first, uint32_t count, std::vector<PacketQuery>& queries) const;
  void fill_rows(const RowTarget& target, std::span<const PacketQuery> queries, TracerCounts& counts) const;
  void fill_form_factors(std::span<const SliceHit> hits, uint32_t receiver, uint32_t own_facet, double u,
                         Row& row) const;

  const Surface& surface_;
  SliceOptions options_;
  PatchSet patch_set_;
  double max_distance_texels_;
  HeightPyramid pyramid_;
  SliceFamilies families_;
};

SliceTracer::SliceTracer(const Surface& surface, const SliceOptions& options)
    : surface_(surface),
      options_(options),
      patch_set_(make_patches(surface, options.patch_kind)),
      max_distance_texels_(options.max_distance_m / surface.texel_size_m),
      pyramid_(make_height_pyramid(surface)),
      families_(make_slice_families(options.azimuths, options.patch_kind, options.seed)) {}

int SliceTracer::draw_rotation(const SlicePaths& paths, uint64_t stream, uint64_t index) const {
  return static_cast<int>(unit_interval(mix_bits(options_.seed, stream, index)) * paths.rotations);
}

// Sets how many hits a packet's slices are sampled at, and the offset of the first. The mean weight of a
// receiver's slices is half the secant of its tilt. index: of the hash, of lane 0.
void SliceTracer::set_hit_sampling(double per_slice, uint64_t stream, uint64_t index,
                                   SlicePacket& packet) const {
  for (uint64_t lane = 0; lane < kSliceLanes; ++lane) {
    const double x = static_cast<double>(packet.tangent_slope_x[lane]),
                 y = static_cast<double>(packet.tangent_slope_y[lane]);
    packet.hits_per_weight[lane] = static_cast<float>(2 * per_slice / std::sqrt(1 + x * x + y * y));
    packet.hit_offset[lane] =
        static_cast<float>(unit_interval(mix_bits(options_.seed, stream, index + lane)));
  }
}

// Returns the packet of texels from (x, y) on. x: a multiple of kSliceLanes.
SlicePacket SliceTracer::texel_packet(int x, int y) const {
  SlicePacket packet;
  packet.x = x;
  packet.y = y;
  const int lanes = std::min(kSliceLanes, surface_.width() - x);
  packet.lanes = (1u << lanes) - 1;
  packet.rotation = draw_rotation(families_.texels, kTexelRotation, surface_.heights_m.index(x, y));
  for (int lane = 0; lane < lanes; ++lane) {
    const size_t l = static_cast<size_t>(lane);
    const glm::vec3& n = surface_.normals(x + lane, y);
    packet.base[l] = *pyramid_.heights.at(x + lane, y) + static_cast<float>(options_.lift_texels);
    packet.tangent_slope_x[l] = -n.x / n.z;
    packet.tangent_slope_y[l] = -n.y / n.z;
  }
  set_hit_sampling(kTexelHits, kTexelHitOffset, surface_.heights_m.index(x, y), packet);
  return packet;
}

SlicePacket SliceTracer::node_packet(const NodeGroup& group) const {
  const PatchRun& run = group.run;
  const SlicePaths& paths = families_.nodes[node_family(group.half, group.node)];
  const int corner = static_cast<int>(group.half);
  SlicePacket packet;
  packet.x = static_cast<int>(run.first_cell % patch_set_.columns);
  packet.y = static_cast<int>(run.first_cell / patch_set_.columns);
  packet.lanes = run.cells_with(group.half, group.node);
  packet.rotation = draw_rotation(paths, kNodeRotation, group.first);
  packet.corner = static_cast<float>(corner);
  for (int lane = 0; lane < static_cast<int>(run.cells); ++lane) {
    const size_t l = static_cast<size_t>(lane);
    const auto height = [&](int dx, int dy) {
      return *pyramid_.heights.at(packet.x + lane + dx, packet.y + dy);
    };
    // The legs of the right angle run along x and y, towards the cell's other side.
    packet.base[l] = height(corner, corner) + static_cast<float>(options_.lift_texels);
    packet.tangent_slope_x[l] = packet.plane_x[l] = height(1, corner) - height(0, corner);
    packet.tangent_slope_y[l] = packet.plane_y[l] = height(corner, 1) - height(corner, 0);
  }
  set_hit_sampling(kNodeHits, kNodeHitOffset, uint64_t{group.first} * kSliceLanes, packet);
  return packet;
}

// Traces packets; the views are valid until this thread's next call.
std::span<const PacketView> SliceTracer::trace_packets(const SlicePaths& paths, Query query,
                                                       std::span<const SlicePacket> packets) const {
  thread_local std::vector<PacketView> scratch;  // keeps its memory
  scratch.resize(std::max(scratch.size(), packets.size()));
  const std::span<PacketView> views(scratch.data(), packets.size());
  for (PacketView& view : views) clear(view);
  const bool limited = std::isfinite(max_distance_texels_);
  const bool sampled = query == Query::kSampledHits && !limited;
  traverse_packets(
      pyramid_, paths,
      {limited ? Query::kAllIntervals : query, sampled ? paths.hit_azimuth_stride : 1, max_distance_texels_},
      packets, views);
  for (size_t i = 0; i < packets.size(); ++i) {
    if (limited) clip_to_max_distance(paths, packets[i], views[i]);
    if (sampled) resample_missed_hits(paths, packets[i], views[i]);
  }
  return views;
}

// Traces lanes again, along all azimuths and sampled more densely, that have no hits and yet are blocked.
void SliceTracer::resample_missed_hits(const SlicePaths& paths, const SlicePacket& packet,
                                       PacketView& view) const {
  SlicePacket missed = packet;
  missed.hits_per_weight = {};
  bool any = false;
  for (size_t lane = 0; lane < kSliceLanes; ++lane) {
    if ((packet.lanes >> lane & 1) == 0 || !view.hits[lane].empty()) continue;
    const double whole = cosine_sum(packet, view.hemisphere, lane);
    const double blocked = whole - cosine_sum(packet, view.sky, lane);
    if (blocked < kLeastBlocked * whole) continue;
    missed.hits_per_weight[lane] = static_cast<float>(kFewestHits / blocked);
    any = true;
  }
  if (!any) return;
  PacketView again;
  traverse_packets(pyramid_, paths, {Query::kSampledHits, 1, max_distance_texels_}, {&missed, 1},
                   {&again, 1});
  for (size_t lane = 0; lane < kSliceLanes; ++lane)
    if (missed.hits_per_weight[lane] > 0) view.hits[lane] = std::move(again.hits[lane]);
}

// Clips intervals to the maximum distance, adds the rest to the sky, and fills the hits.
void SliceTracer::clip_to_max_distance(const SlicePaths& paths, const SlicePacket& packet,
                                       PacketView& view) const {
  for (size_t lane = 0; lane < kSliceLanes; ++lane) {
    std::vector<VisibleInterval> near_intervals;
    for (const VisibleInterval& interval : view.intervals[lane]) {
      const SlicePath& path =
          paths.paths[paths.path_index(packet.rotation, static_cast<int>(interval.azimuth))];
      const SliceRay slice{glm::dvec2(packet.x + static_cast<int>(lane), packet.y) + path.origin,
                           path.direction,
                           static_cast<double>(packet.tangent_slope_x[lane]) * path.direction.x +
                               static_cast<double>(packet.tangent_slope_y[lane]) * path.direction.y};
      VisibleInterval near = clip_interval(surface_, interval, slice.direction, max_distance_texels_);
      const IntervalIntegrals all =
          integrate_interval(static_cast<double>(interval.low), static_cast<double>(interval.high));
      const IntervalIntegrals part =
          integrate_interval(static_cast<double>(near.low), static_cast<double>(near.high));
      view.sky.uniform[lane] += all.uniform - part.uniform;
      view.sky.x[lane] += slice.direction.x * (all.horizontal - part.horizontal);
      view.sky.y[lane] += slice.direction.y * (all.horizontal - part.horizontal);
      view.sky.z[lane] += all.vertical - part.vertical;
      near.weight = static_cast<float>(part.cosine(slice.tangent_slope));
      if (near.weight <= 0) continue;
      near_intervals.push_back(near);
      append_hits(surface_, near, slice, packet.hits_per_weight[lane], view.hits[lane]);
    }
    view.intervals[lane] = std::move(near_intervals);
  }
}

// Fills the form factors of a row from its receiver's hits. own_facet: kNoFacet: a texel. u: in [0, 1).
void SliceTracer::fill_form_factors(std::span<const SliceHit> hits, uint32_t receiver, uint32_t own_facet,
                                    double u, Row& row) const {
  // Rounding may leave a little of the own facet where a path leaves it at a corner.
  double blocked = 0;
  for (const SliceHit& hit : hits)
    if (hit.facet != own_facet) blocked += static_cast<double>(hit.weight);
  const double scale = blocked > 0 ? (1 - row.direct_over_pi) / blocked : 0;
  for (const SliceHit& hit : hits) {
    if (hit.facet == own_facet) continue;
    u = cranley_patterson_rotate(u, kGoldenStep);
    add_form_factors(surface_, patch_set_, options_.texel_links,
                     {hit.facet, {hit.u, hit.v}, hit.distance, static_cast<double>(hit.weight) * scale}, u,
                     row.links);
  }
  // Only ground beyond the border blocks the rest.
  if (surface_.edge == Edge::kGround && row.links.empty() && 1 - row.direct_over_pi >= kLeastBlocked)
    add_own_form_factor(surface_, patch_set_, receiver, own_facet != kNoFacet, 1 - row.direct_over_pi,
                        row.links);
  complete_row(row);
}

// Traces the queried packets and fills their rows.
void SliceTracer::fill_rows(const RowTarget& target, std::span<const PacketQuery> queries,
                            TracerCounts& counts) const {
  const bool of_nodes = &target.paths != &families_.texels;
  const size_t together = of_nodes            ? kNodePacketsTogether
                          : target.with_links ? kTexelPacketsWithLinks
                                              : kTexelPacketsTogether;
  for (size_t begin = 0; begin < queries.size(); begin += together) {
    const auto piece = queries.subspan(begin, std::min(together, queries.size() - begin));
    std::vector<SlicePacket> packets;
    for (const PacketQuery& query : piece) packets.push_back(query.packet);
    const std::span<const PacketView> views =
        trace_packets(target.paths, target.with_links ? Query::kSampledHits : Query::kHorizon, packets);
    for (size_t i = 0; i < piece.size(); ++i) {
      uint32_t receiver = piece[i].receiver;
      for (uint32_t lanes = piece[i].lanes; lanes != 0; lanes &= lanes - 1, ++receiver) {
        const auto lane = static_cast<uint32_t>(std::countr_zero(lanes));
        Row& row = target.row(receiver);
        fill_sky(packets[i], views[i], lane, row);
        row.links.clear();
        counts.rays += static_cast<uint64_t>(target.paths.azimuths);
        counts.truncated += views[i].truncated[lane];
        if (!target.with_links) continue;
        const uint32_t own_facet = of_nodes ? piece[i].first_facet + 2 * lane : kNoFacet;
        const double u =
            unit_interval(mix_bits(options_.seed, of_nodes ? kNodeSample : kTexelSample, receiver));
        fill_form_factors(views[i].hits[lane], receiver, own_facet, u, row);
      }
    }
  }
}

// Adds queries of the texels first, first + 1, …
void SliceTracer::add_texel_queries(uint32_t first, uint32_t count, std::vector<PacketQuery>& queries) const {
  const uint32_t width = static_cast<uint32_t>(surface_.width()), end = first + count;
  for (uint32_t texel = first; texel < end;) {
    const int x = static_cast<int>(texel % width), lane = x % kSliceLanes;
    const SlicePacket packet = texel_packet(x - lane, static_cast<int>(texel / width));
    const uint32_t lanes = first_bits(packet.lanes >> lane, end - texel) << lane;
    queries.push_back({packet, lanes, texel, kNoFacet});
    texel += static_cast<uint32_t>(std::popcount(lanes));
  }
}

void SliceTracer::trace_texels(uint32_t first, bool with_links, std::span<Row> rows,
                               TracerCounts& counts) const {
  std::vector<PacketQuery> queries;
  add_texel_queries(first, static_cast<uint32_t>(rows.size()), queries);
  fill_rows({families_.texels, with_links, rows, first}, queries, counts);
}

void SliceTracer::trace_tile(const TexelTile& tile, std::span<Row> rows, TracerCounts& counts) const {
  const uint32_t map_width = static_cast<uint32_t>(surface_.width());
  const uint32_t first = tile.y * map_width + tile.x;
  std::vector<PacketQuery> queries;
  for (uint32_t j = 0; j < tile.height; ++j) add_texel_queries(first + j * map_width, tile.width, queries);
  fill_rows({families_.texels, false, rows, first, map_width, tile.width}, queries, counts);
}

void SliceTracer::trace_patches(uint32_t first, bool with_links, std::span<Row> rows,
                                TracerCounts& counts) const {
  if (options_.patch_kind == PatchKind::kTexels) return trace_texels(first, with_links, rows, counts);
  const uint32_t end = first + static_cast<uint32_t>(rows.size());
  std::vector<std::vector<PacketQuery>> queries(families_.nodes.size());
  for (uint32_t patch = first; patch < end;) {
    const NodeGroup group = group_of_patch(patch_set_, patch);
    const SlicePacket packet = node_packet(group);
    const uint32_t begun = first_bits(packet.lanes, patch - group.first);
    const uint32_t lanes = first_bits(packet.lanes & ~begun, end - patch);
    queries[node_family(group.half, group.node)].push_back(
        {packet, lanes, patch, 2 * group.run.first_cell + group.half});
    patch += static_cast<uint32_t>(std::popcount(lanes));
  }
  for (size_t family = 0; family < queries.size(); ++family)
    fill_rows({families_.nodes[family], with_links, rows, first}, queries[family], counts);
}

std::vector<RayRecord> SliceTracer::replay_texel(uint32_t texel) const {
  const int x = static_cast<int>(texel) % surface_.width(), y = static_cast<int>(texel) / surface_.width();
  const int lane = x % kSliceLanes;
  const SlicePacket packet = texel_packet(x - lane, y);
  return replay_slices(surface_, families_.texels, packet,
                       trace_packets(families_.texels, Query::kAllIntervals, {&packet, 1})[0],
                       static_cast<size_t>(lane));
}

// Heights and max mips, with what making them takes.
constexpr size_t kPyramidBytesPerTexel = 8;
// Views and hits of the packets traced together.
constexpr size_t kBytesPerThread = size_t{2} << 20, kBytesPerThreadWithLinks = size_t{6} << 20;

}  // namespace

size_t slice_tracer_bytes(uint32_t texels, const SliceOptions& options, bool with_links) {
  const SliceFamilies families = make_slice_families(options.azimuths, options.patch_kind, options.seed);
  size_t bytes = kPyramidBytesPerTexel * texels + cache_bytes(families.texels);
  if (with_links)
    for (const SlicePaths& paths : families.nodes) bytes += cache_bytes(paths);
  return bytes +
         static_cast<size_t>(thread_count()) * (with_links ? kBytesPerThreadWithLinks : kBytesPerThread);
}

std::unique_ptr<Tracer> make_slice_tracer(const Surface& surface, const SliceOptions& options) {
  return std::make_unique<SliceTracer>(surface, options);
}

}  // namespace hemibake
