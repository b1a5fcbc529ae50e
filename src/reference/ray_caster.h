// Rays against the surface, cell by cell in double precision: the referee's own way to follow a ray. It
// shares neither code nor library with the tracers it judges.
//
// Lengths are in units of texels: x, y with texel centres at integers, z = height / texel size. The surface
// is the one of surface/facets.h: triangles through texel centres, diagonal from (i+1, j) to (i, j+1).
//
// No ray slips through: inside one triangle the height of the ray above the plane is linear, a ray is above
// where it enters, and it hits if it is below where it leaves; no other test decides. A wrapping map has no
// seam, since cell indices wrap and the ray moves back by whole tiles.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "core/grid.h"
#include "surface/ray_outcome.h"
#include "surface/surface.h"

namespace hemibake {

struct SurfacePoint {
  glm::dvec3 position;  // texels
  glm::dvec3 normal;    // unit
};

// Truncates rays that are still below the highest texel after a horizontal distance of 10⁵ height ranges (at
// least 10⁵ texels), which only rays within 10⁻⁵ rad of the horizon can be.
class HeightFieldRayCaster {
 public:
  // `surface` must outlive the walk. Keeps the maxima of blocks of 4ᵏ × 4ᵏ cells, a twelfth of the map's
  // memory.
  explicit HeightFieldRayCaster(const Surface& surface);

  // Follows the ray from `start`, on or above the surface and inside the map, along `direction` (unit) to the
  // first point of the surface, in `hit` with its position wrapped into the map and its facet's normal.
  RayOutcome follow(const glm::dvec3& start, const glm::dvec3& direction, SurfacePoint& hit) const;

  // The point of the facet (numbered as in surface/facets.h) at shares u, v ≥ 0, u + v ≤ 1, of its legs along
  // x and y.
  SurfacePoint point_on_facet(uint32_t facet, double u, double v) const;
  uint32_t facet_count() const;

  // How far above the surface a ray starts where `wanted_texels` (above 0) are asked for: less on a map with
  // less relief than a texel, which must not be jumped over, more where rounding of a very high one would
  // swallow it.
  double start_lift(double wanted_texels) const;

 private:
  // One half of a cell as a plane: the right-angled corner and the height gained along each leg.
  struct Half {
    double corner_x, corner_y, corner_m, slope_x_m, slope_y_m;
    double height_m(double x, double y) const {
      return corner_m + (x - corner_x) * slope_x_m + (y - corner_y) * slope_y_m;
    }
  };
  struct Ray;
  struct Block {
    int begin_x, end_x, begin_y, end_y;  // cells
    float top_m;
  };

  float height_m(int x, int y) const;
  Half half_of(int cell_x, int cell_y, bool far_half) const;
  SurfacePoint point_on(const Half& half, double x, double y) const;
  Block block_at(int cell_x, int cell_y, int level) const;
  void build_tops();
  bool hits_cell(const Ray& ray, int cell_x, int cell_y, double enter, double leave, SurfacePoint& hit) const;
  bool hits_half(const Ray& ray, const Half& half, double enter, double leave, SurfacePoint& hit) const;

  const Surface& surface_;
  int cells_x_, cells_y_;
  double range_m_;
  double lost_distance_;
  std::vector<Grid<float>> tops_m_;  // [k]: maxima of blocks of 4^(k+1) cells a side
};

}  // namespace hemibake
