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
#include "tracers/link_merge.h"
#include "tracers/slice/families.h"
#include "tracers/slice/height_pyramid.h"
#include "tracers/slice/links.h"
#include "tracers/slice/replay.h"
#include "tracers/slice/walk.h"

namespace hemibake {
namespace {

// Hash streams, one per use: apart from those of the other tracers.
constexpr uint64_t kTexelTurn = 0x511ce01, kNodeTurn = 0x511ce03, kTexelPlace = 0x511ce04,
                   kNodePlace = 0x511ce05, kTexelChoice = 0x511ce06, kNodeChoice = 0x511ce07;

// Hits for links of a slice that holds the mean share of its receiver's hemisphere. Nodes take fewer: what a
// texel gathers averages over many of them.
constexpr double kTexelHits = kHitsPerSlice, kNodeHits = 1.5;

// Packets walked together: with links, what they meet stays in the cache; without, more packets follow the
// same path.
constexpr size_t kNodePacketsTogether = 64, kTexelPacketsTogether = 1024, kTexelPacketsWithLinks = 16;

// Less than this share of the light blocked counts as none: a tenth of what a horizon may be off by.
constexpr double kLeastBlocked = 1e-5;
// Hits wanted of a receiver that would have none.
constexpr double kFewestHits = 8;

static_assert(kSliceLanes == kRunCells);

// The receivers asked for of one packet.
struct AskedPacket {
  SlicePacket packet;
  uint32_t lanes;        // bits of those asked for
  uint32_t receiver;     // of the first of them; the next one's is one more
  uint32_t first_facet;  // of lane 0, where the receivers are nodes; the next lane's is two more
};

// Where the row of a receiver lies, `number` receivers of the map after the first one: one after the other,
// or of a tile.
struct RowPlaces {
  uint32_t map_width = 0xffffffff, tile_width = 0;
  size_t of(uint32_t number) const { return size_t{number / map_width} * tile_width + number % map_width; }
};

// The lowest `count` of the bits set, or all of them.
uint32_t first_bits(uint32_t bits, uint32_t count) {
  uint32_t others = bits;
  for (; count > 0 && others != 0; --count) others &= others - 1;
  return bits & ~others;
}

class SliceTracer final : public Tracer {
 public:
  SliceTracer(const Surface& surface, const SliceOptions& options);

  const Surface& surface() const override { return surface_; }
  const PatchSet& patch_set() const override { return patches_; }
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
  int turn_of(const SlicePaths& paths, uint64_t stream, uint64_t place) const;
  void choose_hits(double per_slice, uint64_t stream, uint64_t place, SlicePacket& packet) const;
  SlicePacket texel_packet(int x, int y) const;
  SlicePacket node_packet(const NodeGroup& group) const;
  std::span<const PacketView> look(const SlicePaths& paths, Query what,
                                   std::span<const SlicePacket> packets) const;
  void find_missed_hits(const SlicePaths& paths, const SlicePacket& packet, PacketView& view) const;
  void ask_texels(uint32_t first, uint32_t count, std::vector<AskedPacket>& asked) const;
  void answer(const SlicePaths& paths, bool of_nodes, bool with_links, std::span<const AskedPacket> asked,
              uint32_t first, RowPlaces places, std::span<Row> rows, TracerCounts& counts) const;
  void clip_to_max_distance(const SlicePaths& paths, const SlicePacket& packet, PacketView& view) const;
  void fill_row(const SlicePaths& paths, const SlicePacket& packet, const PacketView& view, size_t lane,
                uint32_t own_facet, double choice, bool with_links, Row& row, TracerCounts& counts) const;

  const Surface& surface_;
  SliceOptions options_;
  PatchSet patches_;
  double max_distance_texels_;
  HeightPyramid field_;
  SliceFamilies families_;
};

SliceTracer::SliceTracer(const Surface& surface, const SliceOptions& options)
    : surface_(surface),
      options_(options),
      patches_(make_patches(surface, options.patch_kind)),
      max_distance_texels_(options.max_distance_m / surface.texel_size_m),
      field_(make_height_pyramid(surface)),
      families_(make_slice_families(options.azimuths, options.patch_kind, options.seed)) {}

int SliceTracer::turn_of(const SlicePaths& paths, uint64_t stream, uint64_t place) const {
  return static_cast<int>(unit_interval(mix_bits(options_.seed, stream, place)) * paths.turns);
}

// The mean over the azimuths of the weight of a receiver's slice is half the secant of its tilt.
void SliceTracer::choose_hits(double per_slice, uint64_t stream, uint64_t place, SlicePacket& packet) const {
  for (uint64_t lane = 0; lane < kSliceLanes; ++lane) {
    const double x = static_cast<double>(packet.rim_x[lane]), y = static_cast<double>(packet.rim_y[lane]);
    packet.hits_per_weight[lane] = static_cast<float>(2 * per_slice / std::sqrt(1 + x * x + y * y));
    packet.place[lane] = static_cast<float>(unit_interval(mix_bits(options_.seed, stream, place + lane)));
  }
}

// The packet that begins at a multiple of kSliceLanes.
SlicePacket SliceTracer::texel_packet(int x, int y) const {
  SlicePacket packet;
  packet.x = x;
  packet.y = y;
  const int lanes = std::min(kSliceLanes, surface_.width() - x);
  packet.lanes = (1u << lanes) - 1;
  packet.turn = turn_of(families_.texels, kTexelTurn, surface_.heights_m.index(x, y));
  for (int lane = 0; lane < lanes; ++lane) {
    const size_t l = static_cast<size_t>(lane);
    const glm::vec3& n = surface_.normals(x + lane, y);
    packet.base[l] = *field_.heights.at(x + lane, y) + static_cast<float>(options_.lift_texels);
    packet.rim_x[l] = -n.x / n.z;
    packet.rim_y[l] = -n.y / n.z;
  }
  choose_hits(kTexelHits, kTexelPlace, surface_.heights_m.index(x, y), packet);
  return packet;
}

SlicePacket SliceTracer::node_packet(const NodeGroup& group) const {
  const PatchRun& run = group.run;
  const SlicePaths& paths = families_.nodes[node_family(group.half, group.node)];
  const int corner = static_cast<int>(group.half);
  SlicePacket packet;
  packet.x = static_cast<int>(run.first_cell % patches_.columns);
  packet.y = static_cast<int>(run.first_cell / patches_.columns);
  packet.lanes = run.cells_with(group.half, group.node);
  packet.turn = turn_of(paths, kNodeTurn, group.first);
  packet.corner = static_cast<float>(corner);
  for (int lane = 0; lane < static_cast<int>(run.cells); ++lane) {
    const size_t l = static_cast<size_t>(lane);
    const auto height = [&](int dx, int dy) {
      return *field_.heights.at(packet.x + lane + dx, packet.y + dy);
    };
    // The legs of the right angle run along x and y, towards the cell's other side.
    packet.base[l] = height(corner, corner) + static_cast<float>(options_.lift_texels);
    packet.rim_x[l] = packet.plane_x[l] = height(1, corner) - height(0, corner);
    packet.rim_y[l] = packet.plane_y[l] = height(corner, 1) - height(corner, 0);
  }
  choose_hits(kNodeHits, kNodePlace, uint64_t{group.first} * kSliceLanes, packet);
  return packet;
}

// What the packets see; good until this thread's next call.
std::span<const PacketView> SliceTracer::look(const SlicePaths& paths, Query what,
                                              std::span<const SlicePacket> packets) const {
  thread_local std::vector<PacketView> scratch;  // keeps its memory
  scratch.resize(std::max(scratch.size(), packets.size()));
  const std::span<PacketView> views(scratch.data(), packets.size());
  for (PacketView& view : views) clear(view);
  const bool limited = std::isfinite(max_distance_texels_), some = what == Query::kSampledHits && !limited;
  walk_packets(
      field_, paths,
      {limited ? Query::kAllIntervals : what, some ? paths.azimuths_per_linked : 1, max_distance_texels_},
      packets, views);
  for (size_t i = 0; i < packets.size(); ++i) {
    if (limited) clip_to_max_distance(paths, packets[i], views[i]);
    if (some) find_missed_hits(paths, packets[i], views[i]);
  }
  return views;
}

// Looks again, along all azimuths and more closely, where a lane has no hits and yet does not see the whole
// sky.
void SliceTracer::find_missed_hits(const SlicePaths& paths, const SlicePacket& packet,
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
  walk_packets(field_, paths, {Query::kSampledHits, 1, max_distance_texels_}, {&missed, 1}, {&again, 1});
  for (size_t lane = 0; lane < kSliceLanes; ++lane)
    if (missed.hits_per_weight[lane] > 0) view.hits[lane] = std::move(again.hits[lane]);
}

// Turns what is farther away than the maximum distance into sky.
void SliceTracer::clip_to_max_distance(const SlicePaths& paths, const SlicePacket& packet,
                                       PacketView& view) const {
  for (size_t lane = 0; lane < kSliceLanes; ++lane) {
    std::vector<VisibleInterval> near_stretches;
    for (const VisibleInterval& stretch : view.stretches[lane]) {
      const SlicePath& path = paths.paths[paths.path_index(packet.turn, static_cast<int>(stretch.azimuth))];
      const glm::dvec2 direction = path.direction;
      const glm::dvec2 start = glm::dvec2(packet.x + static_cast<int>(lane), packet.y) + path.origin;
      VisibleInterval near = clip_stretch(surface_, stretch, direction, max_distance_texels_);
      const SliceStretchSums all =
          sums_between(static_cast<double>(stretch.low), static_cast<double>(stretch.high));
      const SliceStretchSums part =
          sums_between(static_cast<double>(near.low), static_cast<double>(near.high));
      const double rim = static_cast<double>(packet.rim_x[lane]) * direction.x +
                         static_cast<double>(packet.rim_y[lane]) * direction.y;
      view.sky.uniform[lane] += all.uniform - part.uniform;
      view.sky.x[lane] += direction.x * (all.horizontal - part.horizontal);
      view.sky.y[lane] += direction.y * (all.horizontal - part.horizontal);
      view.sky.z[lane] += all.vertical - part.vertical;
      near.weight = static_cast<float>(part.vertical - rim * part.horizontal);
      if (near.weight <= 0) continue;
      near_stretches.push_back(near);
      append_hits(surface_, near, start, direction, rim, packet.hits_per_weight[lane], view.hits[lane]);
    }
    view.stretches[lane] = std::move(near_stretches);
  }
}

void SliceTracer::fill_row(const SlicePaths& paths, const SlicePacket& packet, const PacketView& view,
                           size_t lane, uint32_t own_facet, double choice, bool with_links, Row& row,
                           TracerCounts& counts) const {
  const glm::dvec3 sky(view.sky.x[lane], view.sky.y[lane], view.sky.z[lane]);
  // Over what the same azimuths give with nothing in the way: exactly 1 on open ground.
  row.visible_fraction = std::clamp(view.sky.uniform[lane] / view.hemisphere.uniform[lane], 0.0, 1.0);
  row.direct_over_pi =
      std::clamp(cosine_sum(packet, view.sky, lane) / cosine_sum(packet, view.hemisphere, lane), 0.0, 1.0);
  const double length = glm::length(sky);
  row.bent_normal =
      length > 0 ? sky / length : glm::normalize(glm::dvec3(-packet.rim_x[lane], -packet.rim_y[lane], 1));
  row.links.clear();
  counts.rays += static_cast<uint64_t>(paths.azimuths);
  counts.truncated += view.truncated[lane];
  if (!with_links) return;
  // Where a path leaves its own facet at a corner, rounding may leave a little of it.
  double met = 0;
  for (const SliceHit& hit : view.hits[lane])
    if (hit.facet != own_facet) met += static_cast<double>(hit.weight);
  const double scale = met > 0 ? (1 - row.direct_over_pi) / met : 0;
  for (const SliceHit& hit : view.hits[lane]) {
    if (hit.facet == own_facet) continue;
    choice = cranley_patterson_rotate(choice, kGoldenStep);
    append_links(surface_, patches_, options_.texel_links, hit, static_cast<double>(hit.weight) * scale,
                 choice, row.links);
  }
  merge_links(row);
}

// Fills the rows of all receivers asked for; `first` is the receiver of rows[0].
void SliceTracer::answer(const SlicePaths& paths, bool of_nodes, bool with_links,
                         std::span<const AskedPacket> asked, uint32_t first, RowPlaces places,
                         std::span<Row> rows, TracerCounts& counts) const {
  const size_t together = of_nodes     ? kNodePacketsTogether
                          : with_links ? kTexelPacketsWithLinks
                                       : kTexelPacketsTogether;
  for (size_t begin = 0; begin < asked.size(); begin += together) {
    const auto piece = asked.subspan(begin, std::min(together, asked.size() - begin));
    std::vector<SlicePacket> packets;
    for (const AskedPacket& one : piece) packets.push_back(one.packet);
    const std::span<const PacketView> views =
        look(paths, with_links ? Query::kSampledHits : Query::kHorizon, packets);
    for (size_t i = 0; i < piece.size(); ++i) {
      uint32_t receiver = piece[i].receiver;
      for (uint32_t lanes = piece[i].lanes; lanes != 0; lanes &= lanes - 1, ++receiver) {
        const auto lane = static_cast<uint32_t>(std::countr_zero(lanes));
        const uint32_t own_facet = of_nodes ? piece[i].first_facet + 2 * lane : kNoFacet;
        const double choice =
            unit_interval(mix_bits(options_.seed, of_nodes ? kNodeChoice : kTexelChoice, receiver));
        fill_row(paths, packets[i], views[i], lane, own_facet, choice, with_links,
                 rows[places.of(receiver - first)], counts);
      }
    }
  }
}

// Asks for the texels first, first + 1, …
void SliceTracer::ask_texels(uint32_t first, uint32_t count, std::vector<AskedPacket>& asked) const {
  const uint32_t width = static_cast<uint32_t>(surface_.width()), end = first + count;
  for (uint32_t texel = first; texel < end;) {
    const int x = static_cast<int>(texel % width), lane = x % kSliceLanes;
    const SlicePacket packet = texel_packet(x - lane, static_cast<int>(texel / width));
    const uint32_t lanes = first_bits(packet.lanes >> lane, end - texel) << lane;
    asked.push_back({packet, lanes, texel, kNoFacet});
    texel += static_cast<uint32_t>(std::popcount(lanes));
  }
}

void SliceTracer::trace_texels(uint32_t first, bool with_links, std::span<Row> rows,
                               TracerCounts& counts) const {
  std::vector<AskedPacket> asked;
  ask_texels(first, static_cast<uint32_t>(rows.size()), asked);
  answer(families_.texels, false, with_links, asked, first, {}, rows, counts);
}

void SliceTracer::trace_tile(const TexelTile& tile, std::span<Row> rows, TracerCounts& counts) const {
  const uint32_t map_width = static_cast<uint32_t>(surface_.width());
  const uint32_t first = tile.y * map_width + tile.x;
  std::vector<AskedPacket> asked;
  for (uint32_t j = 0; j < tile.height; ++j) ask_texels(first + j * map_width, tile.width, asked);
  answer(families_.texels, false, false, asked, first, {map_width, tile.width}, rows, counts);
}

void SliceTracer::trace_patches(uint32_t first, bool with_links, std::span<Row> rows,
                                TracerCounts& counts) const {
  if (options_.patch_kind == PatchKind::kTexels) return trace_texels(first, with_links, rows, counts);
  const uint32_t end = first + static_cast<uint32_t>(rows.size());
  std::vector<std::vector<AskedPacket>> asked(families_.nodes.size());
  for (uint32_t patch = first; patch < end;) {
    const NodeGroup group = group_of_patch(patches_, patch);
    const SlicePacket packet = node_packet(group);
    const uint32_t begun = first_bits(packet.lanes, patch - group.first);
    const uint32_t lanes = first_bits(packet.lanes & ~begun, end - patch);
    asked[node_family(group.half, group.node)].push_back(
        {packet, lanes, patch, 2 * group.run.first_cell + group.half});
    patch += static_cast<uint32_t>(std::popcount(lanes));
  }
  for (size_t family = 0; family < asked.size(); ++family)
    answer(families_.nodes[family], true, with_links, asked[family], first, {}, rows, counts);
}

std::vector<RayRecord> SliceTracer::replay_texel(uint32_t texel) const {
  const int x = static_cast<int>(texel) % surface_.width(), y = static_cast<int>(texel) / surface_.width();
  const int lane = x % kSliceLanes;
  const SlicePacket packet = texel_packet(x - lane, y);
  return replay_slices(surface_, families_.texels, packet,
                       look(families_.texels, Query::kAllIntervals, {&packet, 1})[0],
                       static_cast<size_t>(lane));
}

// Heights and their windows as planes; measured: 6.5, and some more while they are made.
constexpr size_t kFieldBytesPerTexel = 8;
// Views of the packets together and the hits in them; measured on the brick wall.
constexpr size_t kBytesPerThread = size_t{2} << 20, kBytesPerThreadWithLinks = size_t{6} << 20;

}  // namespace

size_t slice_tracer_bytes(const Surface& surface, const SliceOptions& options, bool with_links) {
  const SliceFamilies families = make_slice_families(options.azimuths, options.patch_kind, options.seed);
  size_t bytes = kFieldBytesPerTexel * surface.texel_count() + ready_bytes(families.texels);
  if (with_links)
    for (const SlicePaths& paths : families.nodes) bytes += ready_bytes(paths);
  return bytes +
         static_cast<size_t>(thread_count()) * (with_links ? kBytesPerThreadWithLinks : kBytesPerThread);
}

std::unique_ptr<Tracer> make_slice_tracer(const Surface& surface, const SliceOptions& options) {
  return std::make_unique<SliceTracer>(surface, options);
}

}  // namespace hemibake
