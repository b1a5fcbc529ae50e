// Holds the triangles of a surface in Embree and follows rays over them, in units of texels. Rays go on
// through the copies of a wrapping map (tracers/embree/embree.h says how far). Facets at a hole are left out;
// a ray that is below the surface sees sky.
#pragma once

#include <embree3/rtcore.h>

#include <cstdint>
#include <glm/vec3.hpp>

#include "surface/facets.h"
#include "surface/ray_outcome.h"
#include "surface/surface.h"

namespace hemibake {

struct SurfaceHit {
  uint32_t facet = kNoFacet;
  float u = 0, v = 0;          // barycentric coordinates of the facet's corners 1 and 2
  double distance_texels = 0;  // from the start of the ray
  int tiles_crossed = 0;
};

class EmbreeScene {
 public:
  // Throws std::runtime_error where Embree fails (out of memory). `surface` must outlive the scene.
  EmbreeScene(const Surface& surface, double max_distance_m);
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;
  ~EmbreeScene();

  // Follows a ray to its end: kGround where it leaves a map with ground edges downwards. start: texels.
  // direction: unit. own_facet: never hit; kNoFacet: none. hit: filled where the ray hits; null: only the
  // outcome is wanted.
  RayOutcome follow(const glm::vec3& start, const glm::vec3& direction, uint32_t own_facet,
                    SurfaceHit* hit) const;

 private:
  void build();
  void fill_triangles(float* vertices, uint32_t* indices, uint32_t columns, uint32_t rows) const;
  RayOutcome follow_segment(const glm::vec3& start, const glm::vec3& direction, float length,
                            uint32_t own_facet, SurfaceHit* hit) const;
  bool ends_below(const glm::vec3& start, const glm::vec3& direction) const;
  RayOutcome follow_beyond(const glm::vec3& start, const glm::vec3& direction, double first_length,
                           double end, uint32_t own_facet, SurfaceHit* hit) const;
  float length_in_block(float x, float y, const glm::vec3& direction) const;
  uint32_t facet_of_primitive(uint32_t primitive) const;

  const Surface& surface_;
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
  bool wrap_, ground_beyond_, has_holes_;
  int block_width_, block_height_;  // of the repeated map in the scene, texels
  int margin_;
  uint32_t scene_columns_;  // cells in a row of the scene
  float top_texels_;        // height of the highest texel
  float max_distance_texels_;
  double truncation_distance_texels_;  // horizontal; a ray ends there
};

}  // namespace hemibake
