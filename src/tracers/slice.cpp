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
constexpr uint64_t kTexelTurn = 0x511ce01, kFacetTurn = 0x511ce02, kFacetShift = 0x511ce03,
                   kTexelPlace = 0x511ce04, kFacetPlace = 0x511ce05;

// Paths of a family: azimuths times rotations. With fewer azimuths more rotations, so that all receivers
// together see the whole circle; with more rotations fewer packets share a path.
constexpr int kPaths = 512;
// Segments kept ready in a family, about 500 bytes each.
constexpr int kReadySegments = 16384;

// Samples for links of a slice that holds the mean share of its receiver's hemisphere. Facets take fewer:
// what a texel gathers averages over many of them.
constexpr int kTexelStrata = kStrataPerSlice, kFacetStrata = kStrataPerSlice / 3;

// Packets walked together: with links, what they meet stays in the cache.
constexpr size_t kPacketsTogether = 64, kPacketsWithLinks = 16;

constexpr uint32_t kNoFacet = 0xffffffff;

// The receivers asked for of one packet.
struct AskedPacket {
  SlicePacket packet;
  int first_lane, end_lane;
  uint32_t receiver;  // of lane 0; the next lane's is `step` more
  uint32_t step;
};

class SliceTracer final : public Tracer {
 public:
  SliceTracer(const Surface& surface, const SliceOptions& options);

  uint32_t patch_count() const override {
    return options_.patches == Patches::kFacets ? facet_count(surface_) : surface_.texel_count();
  }
  void trace_texel(uint32_t texel, bool with_links, Row& row, TracerCounts& counts) const override {
    trace_texels(texel, with_links, {&row, 1}, counts);
  }
  void trace_patch(uint32_t patch, bool with_links, Row& row, TracerCounts& counts) const override {
    trace_patches(patch, with_links, {&row, 1}, counts);
  }
  void trace_texels(uint32_t first, bool with_links, std::span<Row> rows,
                    TracerCounts& counts) const override;
  void trace_patches(uint32_t first, bool with_links, std::span<Row> rows,
                     TracerCounts& counts) const override;
  std::vector<RayRecord> replay_texel(uint32_t texel) const override;

 private:
  SlicePaths make_paths(bool of_facets, int half) const;
  int turn_of(uint64_t stream, uint64_t place) const;
  void choose_strata(int per_slice, uint64_t stream, uint64_t place, uint64_t step,
                     SlicePacket& packet) const;
  SlicePacket texel_packet(int x, int y) const;
  SlicePacket facet_packet(int column, int row, int half) const;
  std::vector<PacketView> look(const SlicePaths& paths, WalkFor what,
                               std::span<const SlicePacket> packets) const;
  void answer(const SlicePaths& paths, bool of_facets, bool with_links, std::span<const AskedPacket> asked,
              uint32_t first, std::span<Row> rows, TracerCounts& counts) const;
  void clip_to_max_distance(const SlicePaths& paths, const SlicePacket& packet, PacketView& view) const;
  void fill_row(const SlicePaths& paths, const SlicePacket& packet, const PacketView& view, size_t lane,
                uint32_t own_facet, bool with_links, Row& row, TracerCounts& counts) const;

  const Surface& surface_;
  SliceOptions options_;
  int turns_;
  double max_distance_texels_;
  SliceField field_;
  SlicePaths texel_paths_;
  std::array<SlicePaths, 2> facet_paths_;  // by half of the cell
};

SliceTracer::SliceTracer(const Surface& surface, const SliceOptions& options)
    : surface_(surface),
      options_(options),
      turns_(std::max(1, kPaths / options.azimuths)),
      max_distance_texels_(options.max_distance_m / surface.texel_size_m),
      field_(make_slice_field(surface)),
      texel_paths_(make_paths(false, 0)),
      facet_paths_{make_paths(true, 0), make_paths(true, 1)} {}

SlicePaths SliceTracer::make_paths(bool of_facets, int half) const {
  SlicePaths paths;
  paths.azimuths = options_.azimuths;
  paths.turns = turns_;
  for (int turn = 0; turn < paths.turns; ++turn) {
    const uint64_t place = 2 * static_cast<uint64_t>(turn);
    const double shift_u = unit_interval(mix_bits(options_.seed, kFacetShift, place));
    const double shift_v = unit_interval(mix_bits(options_.seed, kFacetShift, place + 1));
    for (int azimuth = 0; azimuth < paths.azimuths; ++azimuth) {
      const uint32_t index = static_cast<uint32_t>(azimuth);
      const double angle = 2 * kPi * (azimuth + (turn + 0.5) / paths.turns) / paths.azimuths;
      const glm::dvec2 uv = sample_uniform_triangle({shift_modulo_one(radical_inverse(2, index), shift_u),
                                                     shift_modulo_one(radical_inverse(3, index), shift_v)});
      const glm::dvec2 origin = !of_facets ? glm::dvec2(0) : half == 0 ? uv : 1.0 - uv;
      paths.paths.push_back(make_slice_path(origin, angle, of_facets));
    }
  }
  prepare_segments(field_, std::max(1, kReadySegments / static_cast<int>(paths.paths.size())), paths);
  return paths;
}

int SliceTracer::turn_of(uint64_t stream, uint64_t place) const {
  return static_cast<int>(unit_interval(mix_bits(options_.seed, stream, place)) * turns_);
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
  packet.turn = turn_of(kTexelTurn, surface_.heights_m.index(x, y));
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

SlicePacket SliceTracer::facet_packet(int column, int row, int half) const {
  const int columns = static_cast<int>(facet_columns(surface_));
  SlicePacket packet;
  packet.x = column;
  packet.y = row;
  packet.lanes = std::min(kSliceLanes, columns - column);
  packet.turn = turn_of(kFacetTurn, 2 * surface_.heights_m.index(column, row) + static_cast<uint64_t>(half));
  packet.corner = static_cast<float>(half);
  for (int lane = 0; lane < packet.lanes; ++lane) {
    const size_t l = static_cast<size_t>(lane);
    const int x = column + lane;
    const auto height = [&](int dx, int dy) { return *field_.heights.at(x + dx, row + dy); };
    // The legs of the right angle run along x and y, towards the cell's other side.
    packet.base[l] = height(half, half) + static_cast<float>(options_.lift_texels);
    packet.rim_x[l] = packet.plane_x[l] = height(1, half) - height(0, half);
    packet.rim_y[l] = packet.plane_y[l] = height(half, 1) - height(half, 0);
  }
  choose_strata(kFacetStrata, kFacetPlace,
                2 * surface_.heights_m.index(column, row) + static_cast<uint64_t>(half), 2, packet);
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
      const glm::dvec2 direction =
          paths.paths[paths.path_index(packet.turn, static_cast<int>(stretch.azimuth))].direction;
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
      append_hits(near, rim, packet.strata_per_weight[lane], view.hits[lane]);
    }
    view.stretches[lane] = std::move(near_stretches);
  }
}

void SliceTracer::fill_row(const SlicePaths& paths, const SlicePacket& packet, const PacketView& view,
                           size_t lane, uint32_t own_facet, bool with_links, Row& row,
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
  counts.rays += static_cast<uint64_t>(options_.azimuths);
  counts.cut_short += view.cut_short[lane];
  if (!with_links) return;
  for (const SliceHit& hit : view.hits[lane]) {
    // Where a path leaves its own facet at a corner, rounding may leave a little of it.
    if (hit.facet == own_facet) continue;
    const SlicePath& path = paths.paths[paths.path_index(packet.turn, static_cast<int>(hit.azimuth))];
    const glm::dvec2 start = glm::dvec2(packet.x + static_cast<int>(lane), packet.y) + path.origin;
    append_links(surface_, options_, hit, static_cast<double>(hit.weight) / whole, start, path.direction,
                 row.links);
  }
  merge_links(row);
}

// Fills the rows of all receivers asked for; `first` is the receiver of rows[0].
void SliceTracer::answer(const SlicePaths& paths, bool of_facets, bool with_links,
                         std::span<const AskedPacket> asked, uint32_t first, std::span<Row> rows,
                         TracerCounts& counts) const {
  const size_t together = with_links ? kPacketsWithLinks : kPacketsTogether;
  for (size_t begin = 0; begin < asked.size(); begin += together) {
    const auto piece = asked.subspan(begin, std::min(together, asked.size() - begin));
    std::vector<SlicePacket> packets;
    for (const AskedPacket& one : piece) packets.push_back(one.packet);
    const std::vector<PacketView> views = look(paths, with_links ? WalkFor::kHits : WalkFor::kSky, packets);
    for (size_t i = 0; i < piece.size(); ++i)
      for (int lane = piece[i].first_lane; lane < piece[i].end_lane; ++lane) {
        const uint32_t receiver = piece[i].receiver + piece[i].step * static_cast<uint32_t>(lane);
        fill_row(paths, packets[i], views[i], static_cast<size_t>(lane), of_facets ? receiver : kNoFacet,
                 with_links, rows[receiver - first], counts);
      }
  }
}

void SliceTracer::trace_texels(uint32_t first, bool with_links, std::span<Row> rows,
                               TracerCounts& counts) const {
  const uint32_t width = static_cast<uint32_t>(surface_.width()),
                 end = first + static_cast<uint32_t>(rows.size());
  std::vector<AskedPacket> asked;
  for (uint32_t texel = first; texel < end;) {
    const int x = static_cast<int>(texel % width), lane = x % kSliceLanes;
    const SlicePacket packet = texel_packet(x - lane, static_cast<int>(texel / width));
    const int count = std::min(packet.lanes - lane, static_cast<int>(end - texel));
    asked.push_back({packet, lane, lane + count, texel - static_cast<uint32_t>(lane), 1});
    texel += static_cast<uint32_t>(count);
  }
  answer(texel_paths_, false, with_links, asked, first, rows, counts);
}

void SliceTracer::trace_patches(uint32_t first, bool with_links, std::span<Row> rows,
                                TracerCounts& counts) const {
  if (options_.patches == Patches::kTexels) return trace_texels(first, with_links, rows, counts);
  const uint32_t columns = facet_columns(surface_), end = first + static_cast<uint32_t>(rows.size());
  for (uint32_t half = 0; half < 2; ++half) {
    const uint32_t first_cell = (first + 1 - half) / 2, end_cell = (end + 1 - half) / 2;
    std::vector<AskedPacket> asked;
    for (uint32_t cell = first_cell; cell < end_cell;) {
      const int column = static_cast<int>(cell % columns), lane = column % kSliceLanes;
      const SlicePacket packet =
          facet_packet(column - lane, static_cast<int>(cell / columns), static_cast<int>(half));
      const int count = std::min(packet.lanes - lane, static_cast<int>(end_cell - cell));
      asked.push_back({packet, lane, lane + count, 2 * (cell - static_cast<uint32_t>(lane)) + half, 2});
      cell += static_cast<uint32_t>(count);
    }
    answer(facet_paths_[half], true, with_links, asked, first, rows, counts);
  }
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
      const SliceHit middle{stretch->facet, stretch->weight,           (stretch->low + stretch->high) / 2,
                            stretch->high,  stretch->inverse_distance, stretch->azimuth};
      const double distance = hit_distance(surface_, middle, direction);
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
