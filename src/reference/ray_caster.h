// Casts rays against the surface, cell by cell in double precision. It shares neither code nor library with
// the tracers that the reference path tracer judges.
//
// Lengths are in texels: x, y with texel centres at integers, z = height / texel size. The surface is the one
// of surface/facets.h: triangles through texel centres, diagonal from (i+1, j) to (i, j+1).
//
// No ray leaks: inside one triangle the height of the ray above the plane is linear, a ray is above where it
// enters, and it hits if it is below where it leaves; no other test decides. A wrapping map has no seam,
// since cell indices wrap and the ray moves back by whole tiles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "core/grid.h"
#include "surface/ray_outcome.h"
#include "surface/surface.h"

namespace hemibake {

struct SurfacePoint {
  glm::dvec3 position;  // texels
  glm::dvec3 normal;    // unit
};

// Returns the centre of a texel with its shading normal. texel: row-major index.
SurfacePoint texel_center(const Surface& surface, size_t texel);

// Truncates rays that are still below the highest texel after a horizontal distance of 10⁵ height ranges (at
// least 10⁵ texels), which only rays within 10⁻⁵ rad of the horizon can be.
class HeightFieldRayCaster {
 public:
  // Builds the max mips of blocks of 4ᵏ × 4ᵏ cells, a twelfth of the map's memory.
  // surface: must outlive the caster.
  explicit HeightFieldRayCaster(const Surface& surface);

  // Casts a ray to the first point of the surface; kGround where it leaves a map with ground edges downwards.
  // start: on or above the surface and inside the map, texels.
  // direction: unit.
  // hit: set if the outcome is kHit: position wrapped into the map, normal of the facet.
  // kBelow where it comes through a hole and meets the underside, or leaves the map below the surface.
  RayOutcome cast(const glm::dvec3& start, const glm::dvec3& direction, SurfacePoint& hit) const;

  // Returns the point of a facet at shares u, v of its legs along x and y.
  // facet: numbered as in surface/facets.h. u, v: 0.., u + v ≤ 1.
  SurfacePoint point_on_facet(uint32_t facet, double u, double v) const;
  uint32_t facet_count() const;

  // Returns the height above the surface at which rays start, texels: less than wanted on a map with less
  // relief than a texel, which must not be jumped over, more where rounding of a very high map would swallow
  // it. wanted_texels: above 0.
  double start_lift(double wanted_texels) const;

 private:
  // The plane of a triangle: its right-angled corner and the height gained along each leg.
  struct Triangle {
    double corner_x, corner_y, corner_m, slope_x_m, slope_y_m;
    double height_m(double x, double y) const {
      return corner_m + (x - corner_x) * slope_x_m + (y - corner_y) * slope_y_m;
    }
  };
  struct Ray;
  struct Cell {
    int x, y, level;  // level: of the block around it that is tested, of 4ˡᵉᵛᵉˡ cells a side
  };
  struct Block {
    int begin_x, end_x, begin_y, end_y;  // cells
    float max_m;
  };

  float height_m(int x, int y) const;
  Triangle triangle_of(const Cell& cell, bool far_half) const;
  SurfacePoint point_on(const Triangle& triangle, double x, double y) const;
  Block block_at(const Cell& cell) const;
  void build_max_mips();
  Ray make_ray(const glm::dvec3& start, const glm::dvec3& direction) const;
  bool is_open(const Cell& cell, bool far_half) const;
  std::optional<RayOutcome> meet_cell(Ray& ray, const Cell& cell, double enter, double leave,
                                      SurfacePoint& hit) const;
  std::optional<RayOutcome> meet_triangle(Ray& ray, const Cell& cell, bool far_half, double enter,
                                          double leave, SurfacePoint& hit) const;
  bool enter_next(const Block& block, bool along_x, double t, Ray& ray, Cell& cell) const;

  const Surface& surface_;
  int cells_x_, cells_y_;
  double range_m_;
  double truncation_texels_;
  std::vector<Grid<float>> max_mips_m_;  // [k]: maxima of blocks of 4^(k+1) cells a side
};

}  // namespace hemibake
