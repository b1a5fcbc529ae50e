#include "tracers/slice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/constants.h"
#include "sampling/low_discrepancy.h"
#include "sampling/warp.h"
#include "surface/facets.h"
#include "tracers/link_merge.h"
#include "tracers/slice_field.h"
#include "tracers/slice_links.h"
#include "tracers/slice_path.h"
#include "tracers/slice_walk.h"

namespace hemibake {
namespace {

// Hash streams, one per use: apart from those of the other tracers.
constexpr uint64_t kTexelTurn = 0x511ce01, kNodeTurn = 0x511ce02, kNodeShift = 0x511ce03,
                   kTexelPlace = 0x511ce04, kNodePlace = 0x511ce05, kTexelChoice = 0x511ce06,
                   kNodeChoice = 0x511ce07;

// Paths of a family: azimuths times rotations. With fewer azimuths more rotations, so that all receivers
// together see the whole circle; with more rotations fewer packets share a path.
constexpr int kTexelPaths = 512, kNodePaths = 128;
// Segments kept ready in a family, about 500 bytes each. There is one family of texels and 42 of nodes.
constexpr int kReadyTexelSegments = 16384, kReadyNodeSegments = 1024;

// Samples for links of a slice that holds the mean share of its receiver's hemisphere. Nodes take fewer: what
// a texel gathers averages over many of them.
constexpr int kTexelStrata = kStrataPerSlice, kNodeStrata = kStrataPerSlice / 3;

// Packets walked together: with links, what they meet stays in the cache.
constexpr size_t kPacketsTogether = 64, kPacketsWithLinks = 16;

constexpr uint32_t kNoFacet = 0xffffffff;

static_assert(kSliceLanes == kRunCells);

// The receivers asked for of one packet.
struct AskedPacket {
  SlicePacket packet;
  int first_lane, end_lane;
  uint32_t receiver;     // of lane 0; the next lane's is one more
  uint32_t first_facet;  // of lane 0, where the receivers are nodes; the next lane's is two more
};

// Where the row of a receiver lies, `number` receivers of the map after the first one: one after the other,
// or of a tile.
struct RowPlaces {
  uint32_t map_width = 0xffffffff, tile_width = 0;
  size_t of(uint32_t number) const { return size_t{number / map_width} * tile_width + number % map_width; }
};

// Families of nodes: by subdivision, half of the cell and node.
size_t node_family(int k, uint32_t half, uint32_t node) {
  const uint32_t coarser = k == kFineSubdivision ? 2 * node_count(kCoarseSubdivision) : 0;
  return coarser + half * node_count(k) + node;
}

SlicePaths make_turned_paths(int azimuths, int paths) {
  SlicePaths family;
  family.azimuths = azimuths;
  family.turns = std::max(1, paths / azimuths);
  return family;
}

// Where in its share of the circle a turn begins: nowhere near a simple fraction, so that no path runs
// exactly along the grid or a diagonal. On a wrapping map such a path meets the same few texels for ever, and
// is followed to the far limit where the highest one is not among them.
constexpr double kTurnOffset = 0.381966011;

double angle_of(const SlicePaths& family, int turn, int azimuth) {
  return 2 * kPi * (azimuth + (turn + kTurnOffset) / family.turns) / family.azimuths;
}

class SliceTracer final : public Tracer {
 public:
  SliceTracer(const Surface& surface, const SliceOptions& options);

  const PatchSet& patches() const override { return patches_; }
  void trace_texel(uint32_t texel, bool with_links, Row& row, TracerCounts& counts) const override {
    trace_texels(texel, with_links, {&row, 1}, counts);
  }
  void trace_patch(uint32_t patch, bool with_links, Row& row, TracerCounts& counts) const override {
    trace_patches(patch, with_links, {&row, 1}, counts);
  }
  void trace_texels(uint32_t first, bool with_links, std::span<Row> rows,
                    TracerCounts& counts) const override;
  void trace_tile(uint32_t map_width, const TexelTile& tile, std::span<Row> rows,
                  TracerCounts& counts) const override;
  void trace_patches(uint32_t first, bool with_links, std::span<Row> rows,
                     TracerCounts& counts) const override;
  std::unique_ptr<Tracer> reseeded(uint64_t seed) const override {
    auto again = std::make_unique<SliceTracer>(*this);
    again->options_.seed = seed;
    return again;
  }
  std::vector<RayRecord> replay_texel(uint32_t texel) const override;

 private:
  SlicePaths make_texel_paths() const;
  SlicePaths make_node_paths(int k, uint32_t half, uint32_t node) const;
  int turn_of(const SlicePaths& paths, uint64_t stream, uint64_t place) const;
  void choose_strata(int per_slice, uint64_t stream, uint64_t place, uint64_t step,
                     SlicePacket& packet) const;
  SlicePacket texel_packet(int x, int y) const;
  SlicePacket node_packet(const PatchRun& run, uint32_t half, uint32_t node) const;
  std::vector<PacketView> look(const SlicePaths& paths, WalkFor what,
                               std::span<const SlicePacket> packets) const;
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
  SliceField field_;
  SlicePaths texel_paths_;
  std::vector<SlicePaths> node_paths_;  // by family; empty where patches are texels
};

SliceTracer::SliceTracer(const Surface& surface, const SliceOptions& options)
    : surface_(surface),
      options_(options),
      patches_(make_patches(surface, options.patches)),
      max_distance_texels_(options.max_distance_m / surface.texel_size_m),
      field_(make_slice_field(surface)),
      texel_paths_(make_texel_paths()) {
  if (options.patches != Patches::kFacets) return;
  for (const int k : {kCoarseSubdivision, kFineSubdivision})
    for (uint32_t half = 0; half < 2; ++half)
      for (uint32_t node = 0; node < node_count(k); ++node)
        node_paths_.push_back(make_node_paths(k, half, node));
}

SlicePaths SliceTracer::make_texel_paths() const {
  SlicePaths paths = make_turned_paths(options_.azimuths, kTexelPaths);
  for (int turn = 0; turn < paths.turns; ++turn)
    for (int azimuth = 0; azimuth < paths.azimuths; ++azimuth)
      paths.paths.push_back(make_slice_path({0, 0}, angle_of(paths, turn, azimuth), false));
  prepare_segments(field_, std::max(1, kReadyTexelSegments / static_cast<int>(paths.paths.size())), paths);
  return paths;
}

SlicePaths SliceTracer::make_node_paths(int k, uint32_t half, uint32_t node) const {
  SlicePaths paths = make_turned_paths(azimuths_per_node(options_.azimuths, k), kNodePaths);
  for (int turn = 0; turn < paths.turns; ++turn) {
    const uint64_t place = 2 * static_cast<uint64_t>(turn);
    const double shift_u = unit_interval(mix_bits(options_.seed, kNodeShift, place));
    const double shift_v = unit_interval(mix_bits(options_.seed, kNodeShift, place + 1));
    for (int azimuth = 0; azimuth < paths.azimuths; ++azimuth) {
      const uint32_t index = static_cast<uint32_t>(azimuth);
      const glm::dvec2 point =
          sample_uniform_triangle({shift_modulo_one(radical_inverse(2, index), shift_u),
                                   shift_modulo_one(radical_inverse(3, index), shift_v)});
      const glm::dvec2 uv = node_start_uv(k, node, point);
      paths.paths.push_back(make_slice_path(half == 0 ? uv : 1.0 - uv, angle_of(paths, turn, azimuth), true));
    }
  }
  prepare_segments(field_, std::max(1, kReadyNodeSegments / static_cast<int>(paths.paths.size())), paths);
  return paths;
}

int SliceTracer::turn_of(const SlicePaths& paths, uint64_t stream, uint64_t place) const {
  return static_cast<int>(unit_interval(mix_bits(options_.seed, stream, place)) * paths.turns);
}

// The mean over the azimuths of the weight of a receiver's slice is half the secant of its tilt.
void SliceTracer::choose_strata(int per_slice, uint64_t stream, uint64_t place, uint64_t step,
                                SlicePacket& packet) const {
  for (uint64_t lane = 0; lane < kSliceLanes; ++lane) {
    const double x = static_cast<double>(packet.rim_x[lane]), y = static_cast<double>(packet.rim_y[lane]);
    packet.strata_per_weight[lane] = static_cast<float>(2 * per_slice / std::sqrt(1 + x * x + y * y));
    packet.place[lane] =
        static_cast<float>(unit_interval(mix_bits(options_.seed, stream, place + step * lane)));
  }
}

// The packet that begins at a multiple of kSliceLanes.
SlicePacket SliceTracer::texel_packet(int x, int y) const {
  SlicePacket packet;
  packet.x = x;
  packet.y = y;
  packet.lanes = std::min(kSliceLanes, surface_.width() - x);
  packet.turn = turn_of(texel_paths_, kTexelTurn, surface_.heights_m.index(x, y));
  for (int lane = 0; lane < packet.lanes; ++lane) {
    const size_t l = static_cast<size_t>(lane);
    const glm::vec3& n = surface_.normals(x + lane, y);
    packet.base[l] = *field_.heights.at(x + lane, y) + static_cast<float>(options_.lift_texels);
    packet.rim_x[l] = -n.x / n.z;
    packet.rim_y[l] = -n.y / n.z;
  }
  choose_strata(kTexelStrata, kTexelPlace, surface_.heights_m.index(x, y), 1, packet);
  return packet;
}

SlicePacket SliceTracer::node_packet(const PatchRun& run, uint32_t half, uint32_t node) const {
  const SlicePaths& paths = node_paths_[node_family(run.subdivision, half, node)];
  const uint32_t first_patch = run.patch(half, node, 0);
  const int corner = static_cast<int>(half);
  SlicePacket packet;
  packet.x = static_cast<int>(run.first_cell % patches_.columns);
  packet.y = static_cast<int>(run.first_cell / patches_.columns);
  packet.lanes = static_cast<int>(run.cells);
  packet.turn = turn_of(paths, kNodeTurn, first_patch);
  packet.corner = static_cast<float>(corner);
  for (int lane = 0; lane < packet.lanes; ++lane) {
    const size_t l = static_cast<size_t>(lane);
    const auto height = [&](int dx, int dy) {
      return *field_.heights.at(packet.x + lane + dx, packet.y + dy);
    };
    // The legs of the right angle run along x and y, towards the cell's other side.
    packet.base[l] = height(corner, corner) + static_cast<float>(options_.lift_texels);
    packet.rim_x[l] = packet.plane_x[l] = height(1, corner) - height(0, corner);
    packet.rim_y[l] = packet.plane_y[l] = height(corner, 1) - height(corner, 0);
  }
  choose_strata(kNodeStrata, kNodePlace, first_patch, 1, packet);
  return packet;
}

std::vector<PacketView> SliceTracer::look(const SlicePaths& paths, WalkFor what,
                                          std::span<const SlicePacket> packets) const {
  const bool limited = std::isfinite(max_distance_texels_);
  std::vector<PacketView> views(packets.size());
  walk_packets(field_, paths, {limited ? WalkFor::kStretches : what, max_distance_texels_}, packets, views);
  if (limited)
    for (size_t i = 0; i < packets.size(); ++i) clip_to_max_distance(paths, packets[i], views[i]);
  return views;
}

// Turns what is farther away than the maximum distance into sky.
void SliceTracer::clip_to_max_distance(const SlicePaths& paths, const SlicePacket& packet,
                                       PacketView& view) const {
  for (size_t lane = 0; lane < kSliceLanes; ++lane) {
    std::vector<Stretch> near_stretches;
    for (const Stretch& stretch : view.stretches[lane]) {
      const SlicePath& path = paths.paths[paths.path_index(packet.turn, static_cast<int>(stretch.azimuth))];
      const glm::dvec2 direction = path.direction;
      const glm::dvec2 start = glm::dvec2(packet.x + static_cast<int>(lane), packet.y) + path.origin;
      Stretch near = clip_stretch(surface_, stretch, direction, max_distance_texels_);
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
      append_hits(surface_, near, start, direction, rim, packet.strata_per_weight[lane], view.hits[lane]);
    }
    view.stretches[lane] = std::move(near_stretches);
  }
}

void SliceTracer::fill_row(const SlicePaths& paths, const SlicePacket& packet, const PacketView& view,
                           size_t lane, uint32_t own_facet, double choice, bool with_links, Row& row,
                           TracerCounts& counts) const {
  const auto mean_direction = [&](const SliceSums& sums) {
    return glm::dvec3(sums.x[lane], sums.y[lane], sums.z[lane]);
  };
  const double rim_x = static_cast<double>(packet.rim_x[lane]),
               rim_y = static_cast<double>(packet.rim_y[lane]);
  const glm::dvec3 normal_over_z(-rim_x, -rim_y, 1);
  const glm::dvec3 sky = mean_direction(view.sky);
  const double whole = glm::dot(normal_over_z, mean_direction(view.hemisphere));
  // Over what the same azimuths give with nothing in the way: exactly 1 on open ground.
  row.visible_fraction = std::clamp(view.sky.uniform[lane] / view.hemisphere.uniform[lane], 0.0, 1.0);
  row.direct_over_pi = std::clamp(glm::dot(normal_over_z, sky) / whole, 0.0, 1.0);
  const double length = glm::length(sky);
  row.bent_normal = length > 0 ? sky / length : glm::normalize(normal_over_z);
  row.links.clear();
  counts.rays += static_cast<uint64_t>(paths.azimuths);
  counts.cut_short += view.cut_short[lane];
  if (!with_links) return;
  for (const SliceHit& hit : view.hits[lane]) {
    // Where a path leaves its own facet at a corner, rounding may leave a little of it.
    if (hit.facet == own_facet) continue;
    choice = shift_modulo_one(choice, kGoldenStep);
    append_links(surface_, patches_, options_.texel_links, hit, static_cast<double>(hit.weight) / whole,
                 choice, row.links);
  }
  merge_links(row);
}

// Fills the rows of all receivers asked for; `first` is the receiver of rows[0].
void SliceTracer::answer(const SlicePaths& paths, bool of_nodes, bool with_links,
                         std::span<const AskedPacket> asked, uint32_t first, RowPlaces places,
                         std::span<Row> rows, TracerCounts& counts) const {
  const size_t together = with_links ? kPacketsWithLinks : kPacketsTogether;
  for (size_t begin = 0; begin < asked.size(); begin += together) {
    const auto piece = asked.subspan(begin, std::min(together, asked.size() - begin));
    std::vector<SlicePacket> packets;
    for (const AskedPacket& one : piece) packets.push_back(one.packet);
    const std::vector<PacketView> views = look(paths, with_links ? WalkFor::kHits : WalkFor::kSky, packets);
    for (size_t i = 0; i < piece.size(); ++i)
      for (int lane = piece[i].first_lane; lane < piece[i].end_lane; ++lane) {
        const uint32_t receiver = piece[i].receiver + static_cast<uint32_t>(lane);
        const uint32_t own_facet =
            of_nodes ? piece[i].first_facet + 2 * static_cast<uint32_t>(lane) : kNoFacet;
        const double choice =
            unit_interval(mix_bits(options_.seed, of_nodes ? kNodeChoice : kTexelChoice, receiver));
        fill_row(paths, packets[i], views[i], static_cast<size_t>(lane), own_facet, choice, with_links,
                 rows[places.of(receiver - first)], counts);
      }
  }
}

// Asks for the texels first, first + 1, …
void SliceTracer::ask_texels(uint32_t first, uint32_t count, std::vector<AskedPacket>& asked) const {
  const uint32_t width = static_cast<uint32_t>(surface_.width()), end = first + count;
  for (uint32_t texel = first; texel < end;) {
    const int x = static_cast<int>(texel % width), lane = x % kSliceLanes;
    const SlicePacket packet = texel_packet(x - lane, static_cast<int>(texel / width));
    const int lanes = std::min(packet.lanes - lane, static_cast<int>(end - texel));
    asked.push_back({packet, lane, lane + lanes, texel - static_cast<uint32_t>(lane), kNoFacet});
    texel += static_cast<uint32_t>(lanes);
  }
}

void SliceTracer::trace_texels(uint32_t first, bool with_links, std::span<Row> rows,
                               TracerCounts& counts) const {
  std::vector<AskedPacket> asked;
  ask_texels(first, static_cast<uint32_t>(rows.size()), asked);
  answer(texel_paths_, false, with_links, asked, first, {}, rows, counts);
}

void SliceTracer::trace_tile(uint32_t map_width, const TexelTile& tile, std::span<Row> rows,
                             TracerCounts& counts) const {
  const uint32_t first = tile.y * map_width + tile.x;
  std::vector<AskedPacket> asked;
  for (uint32_t j = 0; j < tile.height; ++j) ask_texels(first + j * map_width, tile.width, asked);
  answer(texel_paths_, false, false, asked, first, {map_width, tile.width}, rows, counts);
}

void SliceTracer::trace_patches(uint32_t first, bool with_links, std::span<Row> rows,
                                TracerCounts& counts) const {
  if (options_.patches == Patches::kTexels) return trace_texels(first, with_links, rows, counts);
  const uint32_t end = first + static_cast<uint32_t>(rows.size());
  std::vector<std::vector<AskedPacket>> asked(node_paths_.size());
  for (uint32_t patch = first; patch < end;) {
    const PatchRun run = run_of_patch(patches_, patch);
    const uint32_t nodes = node_count(run.subdivision), in_run = patch - run.first;
    const uint32_t half = in_run / run.cells / nodes, node = in_run / run.cells % nodes,
                   lane = in_run % run.cells;
    const uint32_t count = std::min(run.cells - lane, end - patch);
    asked[node_family(run.subdivision, half, node)].push_back(
        {node_packet(run, half, node), static_cast<int>(lane), static_cast<int>(lane + count), patch - lane,
         2 * run.first_cell + half});
    patch += count;
  }
  for (size_t family = 0; family < asked.size(); ++family)
    answer(node_paths_[family], true, with_links, asked[family], first, {}, rows, counts);
}

// One record per stretch seen, and one per azimuth for its sky: all of what the links are a sample of.
std::vector<RayRecord> SliceTracer::replay_texel(uint32_t texel) const {
  const int x = static_cast<int>(texel) % surface_.width(), y = static_cast<int>(texel) / surface_.width();
  const size_t lane = static_cast<size_t>(x % kSliceLanes);
  const SlicePacket packet = texel_packet(x - x % kSliceLanes, y);
  const std::vector<PacketView> views = look(texel_paths_, WalkFor::kStretches, {&packet, 1});
  const SliceSums& all = views[0].hemisphere;
  const glm::dvec2 rim_slope(packet.rim_x[lane], packet.rim_y[lane]);
  const double uniform_whole = all.uniform[lane];
  const double cosine_whole = all.z[lane] - rim_slope.x * all.x[lane] - rim_slope.y * all.y[lane];

  std::vector<RayRecord> records;
  auto stretch = views[0].stretches[lane].begin();
  for (int azimuth = 0; azimuth < options_.azimuths; ++azimuth) {
    const glm::dvec2 direction = texel_paths_.paths[texel_paths_.path_index(packet.turn, azimuth)].direction;
    const double rim = glm::dot(rim_slope, direction);
    const auto record_of = [&](double low, double high, const SliceStretchSums& sums) {
      const double middle = (std::atan(low) + std::atan(high)) / 2;
      const glm::dvec3 toward(std::cos(middle) * direction.x, std::cos(middle) * direction.y,
                              std::sin(middle));
      return RayRecord{toward,
                       (sums.vertical - rim * sums.horizontal) / cosine_whole,
                       sums.uniform / uniform_whole,
                       false,
                       0,
                       {0, 0},
                       0,
                       0};
    };
    SliceStretchSums sky = sums_between(rim, HUGE_VAL);
    double horizon = std::max(rim, surface_.edge == Edge::kWrap ? 0 : rim);
    for (; stretch != views[0].stretches[lane].end() && stretch->azimuth == static_cast<uint32_t>(azimuth);
         ++stretch) {
      const double low = static_cast<double>(stretch->low), high = static_cast<double>(stretch->high);
      const SliceStretchSums seen = sums_between(low, high);
      RayRecord record = record_of(low, high, seen);
      const double distance = stretch_distance(surface_, *stretch, (low + high) / 2, direction);
      const glm::dvec2 place = glm::dvec2(x, y) + distance * direction;
      const glm::dvec2 size(surface_.width(), surface_.height());
      const glm::dvec2 tile = glm::floor((place + 0.5) / size);
      record.hit = true;
      record.facet = stretch->facet;
      record.hit_texel = place - tile * size;
      record.distance_m =
          distance / std::hypot(record.direction.x, record.direction.y) * surface_.texel_size_m;
      record.tiles_crossed = static_cast<int>(std::abs(tile.x) + std::abs(tile.y));
      records.push_back(record);
      sky.uniform -= seen.uniform;
      sky.horizontal -= seen.horizontal;
      sky.vertical -= seen.vertical;
      horizon = std::max(horizon, high);
    }
    if (sky.uniform > 0) records.push_back(record_of(horizon, HUGE_VAL, sky));
  }
  return records;
}

}  // namespace

std::unique_ptr<Tracer> make_slice_tracer(const Surface& surface, const SliceOptions& options) {
  return std::make_unique<SliceTracer>(surface, options);
}

}  // namespace hemibake
