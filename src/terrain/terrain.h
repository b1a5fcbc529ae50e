// Sky-view factor, openness and horizon angles of a terrain, as geographic information systems define them.
//
// Every texel is a point on horizontal ground; only elevations above or below the horizontal count, not the
// slope there. γ is the elevation of the horizon at an azimuth (horizon_tracer.h), means are over azimuths.
#pragma once

#include <limits>
#include <vector>

#include "core/grid.h"
#include "surface/surface.h"

namespace hemibake {

// Radius of the earth, and the share of its curvature that refraction takes back (Gauss's coefficient).
inline constexpr double kEarthRadiusM = 6371e3, kRefraction = 0.13;
// Map size from which on the curvature matters, m: there it lowers the horizon by 0.04 degrees.
inline constexpr double kCurvedMapM = 1e4;

struct TerrainOptions {
  bool svf = false, openness = false, negative_openness = false;
  int azimuths = 128;                                         // of these three, 1..
  int horizon_azimuths = 0;                                   // 0: no horizon angles
  double radius_m = std::numeric_limits<double>::infinity();  // farther terrain does not count, > 0
  bool curvature = false;  // terrain at distance d is lower by d² (1 − kRefraction) / (2 kEarthRadiusM)
};

// Planes of the map's size; those not asked for are empty.
struct TerrainPlanes {
  // Mean of 1 − sin max(γ, 0), 0..1 (Zakšek, Oštir, Kokalj, "Sky-View Factor as a Relief Visualization
  // Technique", Remote Sensing 3, 2011).
  Grid<float> svf;
  // Mean of 90° − γ in degrees, 0..180, of the surface and of the surface upside down (Yokoyama, Shirasawa,
  // Pike, "Visualizing Topography by Openness", Photogrammetric Engineering & Remote Sensing 68, 2002).
  Grid<float> openness, negative_openness;
  // γ in degrees, −90..90; azimuth k · 360° / n clockwise from up in the image.
  std::vector<Grid<float>> horizons;

  bool empty() const {
    return svf.empty() && openness.empty() && negative_openness.empty() && horizons.empty();
  }
};

// Makes the planes. The same bytes at any thread count.
TerrainPlanes make_terrain(const Surface& surface, const TerrainOptions& options);

}  // namespace hemibake
