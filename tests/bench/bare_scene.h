// Embree with nothing around it: the triangles of a wrapping map and of a margin of its copies, for
// benchmarks.
#pragma once

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>

#include "surface/surface.h"

namespace hemibake {

constexpr int kMargin = 64;  // as in tracers/embree/embree.cpp

struct BareScene {
  RTCDevice device = rtcNewDevice("threads=1");
  RTCScene scene = rtcNewScene(device);
  explicit BareScene(const Surface& surface) {
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    const uint32_t columns = static_cast<uint32_t>(surface.width() + 2 * kMargin);
    const uint32_t rows = static_cast<uint32_t>(surface.height() + 2 * kMargin);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* v = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, size_t{columns + 1} * (rows + 1)));
    auto* t = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, size_t{2} * columns * rows));
    for (uint32_t j = 0; j <= rows; ++j)
      for (uint32_t i = 0; i <= columns; ++i) {
        const int x = static_cast<int>(i) - kMargin, y = static_cast<int>(j) - kMargin;
        *v++ = static_cast<float>(x);
        *v++ = static_cast<float>(y);
        *v++ = static_cast<float>(
            surface.heights_m(wrap_index(x, surface.width()), wrap_index(y, surface.height())) /
            surface.texel_size_m);
      }
    for (uint32_t j = 0; j < rows; ++j)
      for (uint32_t i = 0; i < columns; ++i) {
        const uint32_t c = j * (columns + 1) + i;
        for (const uint32_t index : {c, c + 1, c + columns + 1, c + columns + 2, c + columns + 1, c + 1})
          *t++ = index;
      }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
  }
  ~BareScene() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

// A ray from the centre of a texel up to the border of the scene, texels; tfar ≤ 0 where it starts above the
// relief.
inline RTCRay texel_ray(const Surface& surface, double top, int x, int y, const glm::dvec3& direction) {
  RTCRay ray{};
  ray.org_x = static_cast<float>(x);
  ray.org_y = static_cast<float>(y);
  ray.org_z = static_cast<float>(static_cast<double>(surface.heights_m(x, y)) / surface.texel_size_m + 1e-3);
  ray.dir_x = static_cast<float>(direction.x);
  ray.dir_y = static_cast<float>(direction.y);
  ray.dir_z = static_cast<float>(direction.z);
  const auto exit = [](double from, double along, double size) {
    return along > 0   ? (size + kMargin - 1 - from) / along
           : along < 0 ? (1 - kMargin - from) / along
                       : HUGE_VAL;
  };
  double end = std::min(exit(x, direction.x, surface.width()), exit(y, direction.y, surface.height()));
  if (direction.z > 0) end = std::min(end, (top - static_cast<double>(ray.org_z)) / direction.z * 1.0001);
  ray.tfar = static_cast<float>(end);
  ray.mask = 0xffffffff;
  return ray;
}

}  // namespace hemibake
