#include "tracers/slice.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/constants.h"
#include "core/parallel.h"
#include "sampling/low_discrepancy.h"
#include "sampling/warp.h"
#include "surface/facets.h"
#include "tracers/link_merge.h"
#include "tracers/slice_field.h"
#include "tracers/slice_path.h"
#include "tracers/slice_walk.h"

namespace hemibake {
namespace {

// Hash streams, one per use.
constexpr uint64_t kTurns = 0x51ce0001;

// Paths kept ready: azimuths times rotations. With fewer azimuths more rotations, so that all receivers together see
// the whole circle.
constexpr int kPaths = 1024;
// Segments kept ready, of all paths: 16 of each of 1024 paths take about 10 MB.
constexpr int kReadySegments = 16 * kPaths;

class SliceTracer final : public Tracer {
 public:
  SliceTracer(const Surface& surface, const SliceOptions& options);

  uint32_t patch_count() const override {
    return options_.patches == Patches::kFacets ? facet_count(surface_) : surface_.texel_count();
  }
  void trace_texel(uint32_t texel, bool with_links, Row& row, TracerCounts& counts) const override {
    trace_texels(texel, with_links, {&row, 1}, counts);
  }
  void trace_patch(uint32_t patch, bool with_links, Row& row, TracerCounts& counts) const override;
  void trace_texels(uint32_t first, bool with_links, std::span<Row> rows, TracerCounts& counts) const override;
  std::vector<RayRecord> replay_texel(uint32_t texel) const override;

 private:
  SlicePaths make_paths() const;
  SlicePacket texel_packet(int x, int y) const;
  int turn_of(int x, int y) const;

  const Surface& surface_;
  SliceOptions options_;
  SliceField field_;
  SlicePaths texel_paths_;
};

SliceTracer::SliceTracer(const Surface& surface, const SliceOptions& options)
    : surface_(surface), options_(options), field_(make_slice_field(surface)), texel_paths_(make_paths()) {}

SlicePaths SliceTracer::make_paths() const {
  SlicePaths paths;
  paths.azimuths = options_.azimuths;
  paths.turns = std::max(1, kPaths / options_.azimuths);
  const int count = paths.azimuths * paths.turns;
  paths.ready_segments = std::max(1, kReadySegments / std::max(kPaths, count));
  for (int turn = 0; turn < paths.turns; ++turn) {
    for (int azimuth = 0; azimuth < paths.azimuths; ++azimuth) {
      const double share = (azimuth + (turn + 0.5) / paths.turns) / paths.azimuths;
      paths.paths.push_back(make_slice_path({0, 0}, 2 * kPi * share));
    }
  }
  paths.segments.resize(static_cast<size_t>(count) * static_cast<size_t>(paths.ready_segments));
  parallel_for(paths.paths.size(), 16, [&](size_t begin, size_t end) {
    for (size_t path = begin; path < end; ++path)
      for (int segment = 0; segment < paths.ready_segments; ++segment)
        find_crossings(paths.paths[path], segment, paths.starts_in_facet, field_.pitch,
                       paths.segments[path * static_cast<size_t>(paths.ready_segments) + static_cast<size_t>(segment)]);
  });
  return paths;
}

int SliceTracer::turn_of(int x, int y) const {
  const uint64_t packet = surface_.heights_m.index(x, y);
  return static_cast<int>(unit_interval(mix_bits(options_.seed, kTurns, packet)) * texel_paths_.turns);
}

SlicePacket SliceTracer::texel_packet(int x, int y) const {
  SlicePacket packet;
  packet.x = x;
  packet.y = y;
  packet.lanes = std::min(kSliceLanes, surface_.width() - x);
  for (int lane = 0; lane < packet.lanes; ++lane) {
    const size_t l = static_cast<size_t>(lane);
    const glm::vec3& n = surface_.normals(x + lane, y);
    packet.base[l] = field_.heights[field_.index(x + lane, y)];
    packet.rim_x[l] = -n.x / n.z;
    packet.rim_y[l] = -n.y / n.z;
  }
  return packet;
}

// What lane l of the packet sees about its normal.
void fill_row(const PacketView& view, size_t lane, const glm::dvec3& normal, Row& row) {
  const auto mean_direction = [&](const SliceSums& sums) {
    return glm::dvec3(sums.x[lane], sums.y[lane], sums.z[lane]);
  };
  const glm::dvec3 sky = mean_direction(view.sky), all = mean_direction(view.hemisphere);
  // Over what the same azimuths give with nothing in the way: exactly 1 on open ground.
  row.visible_fraction = std::clamp(view.sky.uniform[lane] / view.hemisphere.uniform[lane], 0.0, 1.0);
  row.direct_over_pi = std::clamp(glm::dot(normal, sky) / glm::dot(normal, all), 0.0, 1.0);
  const double length = glm::length(sky);
  row.bent_normal = length > 0 ? sky / length : normal;
  row.links.clear();
}

void SliceTracer::trace_texels(uint32_t first, bool, std::span<Row> rows, TracerCounts& counts) const {
  const uint32_t width = static_cast<uint32_t>(surface_.width());
  for (size_t done = 0; done < rows.size();) {
    const uint32_t texel = first + static_cast<uint32_t>(done);
    const int x = static_cast<int>(texel % width), y = static_cast<int>(texel / width);
    const int packet_x = x - x % kSliceLanes;
    const SlicePacket packet = texel_packet(packet_x, y);
    const PacketView view = walk_horizons(field_, texel_paths_, turn_of(packet_x, y), packet);
    for (int lane = x - packet_x; lane < packet.lanes && done < rows.size(); ++lane, ++done) {
      const size_t l = static_cast<size_t>(lane);
      fill_row(view, l, glm::dvec3(surface_.normals(packet_x + lane, y)), rows[done]);
      counts.rays += static_cast<uint64_t>(options_.azimuths);
      counts.cut_short += view.cut_short[l];
    }
  }
}

void SliceTracer::trace_patch(uint32_t patch, bool with_links, Row& row, TracerCounts& counts) const {
  trace_texel(patch, with_links, row, counts);
}

std::vector<RayRecord> SliceTracer::replay_texel(uint32_t) const { return {}; }

}  // namespace

std::unique_ptr<Tracer> make_slice_tracer(const Surface& surface, const SliceOptions& options) {
  return std::make_unique<SliceTracer>(surface, options);
}

}  // namespace hemibake
