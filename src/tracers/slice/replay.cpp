#include "tracers/slice/replay.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "tracers/slice/links.h"

namespace hemibake {

std::vector<RayRecord> replay_slices(const Surface& surface, const SlicePaths& paths,
                                     const SlicePacket& packet, const PacketView& view, size_t lane) {
  const glm::dvec2 texel(packet.x + static_cast<int>(lane), packet.y);
  const glm::dvec2 rim_slope(packet.rim_x[lane], packet.rim_y[lane]);
  const double uniform_whole = view.hemisphere.uniform[lane];
  const double cosine_whole = cosine_sum(packet, view.hemisphere, lane);

  std::vector<RayRecord> records;
  auto stretch = view.stretches[lane].begin();
  for (int azimuth = 0; azimuth < paths.azimuths; ++azimuth) {
    const glm::dvec2 direction = paths.paths[paths.path_index(packet.turn, azimuth)].direction;
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
    double horizon = std::max(rim, surface.edge == Edge::kWrap ? 0 : rim);
    for (; stretch != view.stretches[lane].end() && stretch->azimuth == static_cast<uint32_t>(azimuth);
         ++stretch) {
      const double low = static_cast<double>(stretch->low), high = static_cast<double>(stretch->high);
      const SliceStretchSums seen = sums_between(low, high);
      RayRecord record = record_of(low, high, seen);
      const double distance = stretch_distance(surface, *stretch, (low + high) / 2, direction);
      const glm::dvec2 place = texel + distance * direction;
      const glm::dvec2 size(surface.width(), surface.height());
      const glm::dvec2 tile = glm::floor((place + 0.5) / size);
      record.hit = true;
      record.facet = stretch->facet;
      record.hit_texel = place - tile * size;
      record.distance_m =
          distance / std::hypot(record.direction.x, record.direction.y) * surface.texel_size_m;
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

}  // namespace hemibake
