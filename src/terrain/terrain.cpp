#include "terrain/terrain.h"

#include <algorithm>
#include <cmath>

#include "core/constants.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "terrain/horizon_tracer.h"

namespace hemibake {
namespace {

constexpr double kDegrees = 180 / kPi;
constexpr size_t kGrain = 65536;

double angle_degrees(float slope) { return kDegrees * std::atan(static_cast<double>(slope)); }

double sky_share(float slope) {
  const double above = std::max(0.0, static_cast<double>(slope));
  return 1 - above / std::sqrt(1 + above * above);
}

// Sums a function of the slopes over azimuths, texel by texel.
class MeanPlane {
 public:
  MeanPlane(bool wanted, const Surface& surface)
      : sums_(wanted ? surface.width() : 0, wanted ? surface.height() : 0) {}
  bool wanted() const { return !sums_.empty(); }

  template <class OfSlope>
  void add(const Grid<float>& slopes, const OfSlope& of_slope) {
    parallel_for(sums_.size(), kGrain, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) sums_[i] += of_slope(slopes[i]);
    });
  }
  Grid<float> mean(int count) const {
    Grid<float> mean(sums_.width, sums_.height);
    for (size_t i = 0; i < mean.size(); ++i) mean[i] = static_cast<float>(sums_[i] / count);
    return mean;
  }

 private:
  Grid<double> sums_;
};

double openness_of(float slope) { return 90 - angle_degrees(slope); }

}  // namespace

TerrainPlanes make_terrain(const Surface& surface, const TerrainOptions& options) {
  HorizonReach reach;
  reach.radius_m = options.radius_m;
  if (options.curvature) reach.drop_per_m2 = (1 - kRefraction) / (2 * kEarthRadiusM);
  const int azimuths = options.azimuths;
  MeanPlane svf(options.svf, surface), openness(options.openness, surface),
      negative(options.negative_openness, surface);
  const bool above = svf.wanted() || openness.wanted();
  Progress progress("horizons",
                    static_cast<uint64_t>((above ? azimuths : 0) + (negative.wanted() ? azimuths : 0) +
                                          options.horizon_azimuths),
                    "azimuth");
  TerrainPlanes planes;
  if (above || options.horizon_azimuths > 0) {
    const HorizonTracer tracer(surface, reach, false);
    // Between the axes of the grid, so that no two azimuths see the same edges.
    for (int k = 0; above && k < azimuths; ++k, progress.advance(1)) {
      const Grid<float> slopes = tracer.trace(2 * kPi * (k + 0.5) / azimuths);
      svf.add(slopes, sky_share);
      openness.add(slopes, openness_of);
    }
    for (int k = 0; k < options.horizon_azimuths; ++k, progress.advance(1)) {
      planes.horizons.push_back(tracer.trace(2 * kPi * k / options.horizon_azimuths));
      for (float& value : planes.horizons.back().values) value = static_cast<float>(angle_degrees(value));
    }
  }
  if (negative.wanted()) {
    const HorizonTracer tracer(surface, reach, true);
    for (int k = 0; k < azimuths; ++k, progress.advance(1))
      negative.add(tracer.trace(2 * kPi * (k + 0.5) / azimuths), openness_of);
  }
  planes.svf = svf.mean(azimuths);
  planes.openness = openness.mean(azimuths);
  planes.negative_openness = negative.mean(azimuths);
  return planes;
}

}  // namespace hemibake
