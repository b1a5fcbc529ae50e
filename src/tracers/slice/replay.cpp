#include "tracers/slice/replay.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "tracers/slice/intervals.h"

namespace hemibake {

std::vector<RayRecord> replay_slices(const Surface& surface, const SlicePaths& paths,
                                     const SlicePacket& packet, const SliceReceivers& receivers,
                                     const PacketView& view, size_t lane) {
  const glm::dvec2 texel(packet.x + static_cast<int>(lane), packet.y);
  const glm::dvec2 tangent_slopes(receivers.tangent_slope_x[lane], receivers.tangent_slope_y[lane]);
  const double uniform_whole = view.hemisphere.uniform[lane];
  const double cosine_whole = cosine_sum(receivers, view.hemisphere, lane);

  std::vector<RayRecord> records;
  auto interval = view.intervals[lane].begin();
  for (int azimuth = 0; azimuth < paths.azimuths; ++azimuth) {
    const glm::dvec2 direction = paths.paths[paths.path_index(packet.rotation, azimuth)].direction;
    const double tangent_slope = glm::dot(tangent_slopes, direction);
    const auto record_of = [&](double low, double high, const IntervalIntegrals& sums) {
      const double middle = (std::atan(low) + std::atan(high)) / 2;
      RayRecord record{};
      record.direction = {std::cos(middle) * direction.x, std::cos(middle) * direction.y, std::sin(middle)};
      record.cosine_weight = sums.cosine(tangent_slope) / cosine_whole;
      record.uniform_weight = sums.uniform / uniform_whole;
      return record;
    };
    IntervalIntegrals sky = integrate_interval(tangent_slope, HUGE_VAL);
    double horizon = std::max(tangent_slope, surface.edge != Edge::kOpen ? 0 : tangent_slope);
    for (; interval != view.intervals[lane].end() && interval->azimuth == static_cast<uint32_t>(azimuth);
         ++interval) {
      const double low = static_cast<double>(interval->low), high = static_cast<double>(interval->high);
      const IntervalIntegrals seen = integrate_interval(low, high);
      RayRecord record = record_of(low, high, seen);
      const double distance = interval_distance(surface, *interval, (low + high) / 2, direction);
      const glm::dvec2 position = texel + distance * direction;
      const glm::dvec2 size(surface.width(), surface.height());
      const glm::dvec2 tile = glm::floor((position + 0.5) / size);
      record.hit = true;
      record.facet = interval->facet;
      record.hit_texel = position - tile * size;
      record.distance_m =
          distance / std::hypot(record.direction.x, record.direction.y) * surface.texel_size_m;
      record.tiles_crossed = static_cast<int>(std::abs(tile.x) + std::abs(tile.y));
      records.push_back(record);
      sky.uniform -= seen.uniform;
      sky.horizontal -= seen.horizontal;
      sky.vertical -= seen.vertical;
      horizon = std::max(horizon, high);
    }
    if (surface.edge == Edge::kGround) sky = integrate_interval(horizon, HUGE_VAL);
    if (sky.uniform > 0) records.push_back(record_of(horizon, HUGE_VAL, sky));
  }
  return records;
}

}  // namespace hemibake
