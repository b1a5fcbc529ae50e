#include "tracers/embree/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <new>
#include <stdexcept>

namespace hemibake {
namespace {

// In texels, so that vertices stand on integers, which float holds exactly.
constexpr int kSmallestBlock = 64;  // smaller maps are repeated up to it, so that fewer copies are entered
constexpr int kMargin = 64;         // of neighbouring copies around the block

// Ignores an error: errors are asked for after building, and no exception may leave this callback.
void ignore_embree_error(void*, RTCError, const char*) {}

}  // namespace

EmbreeScene::EmbreeScene(const Surface& surface, double max_distance_m)
    : surface_(surface),
      wrap_(surface.edge == Edge::kWrap),
      ground_beyond_(surface.edge == Edge::kGround),
      has_holes_(!surface.holes.empty()) {
  const double range = height_range_m(surface) / surface.texel_size_m;
  top_texels_ = static_cast<float>(range);
  max_distance_texels_ = static_cast<float>(max_distance_m / surface.texel_size_m);

  const int repeat_x = wrap_ ? (kSmallestBlock + surface.width() - 1) / surface.width() : 1;
  const int repeat_y = wrap_ ? (kSmallestBlock + surface.height() - 1) / surface.height() : 1;
  block_width_ = repeat_x * surface.width();
  block_height_ = repeat_y * surface.height();
  margin_ = wrap_ ? kMargin : 0;
  const double smallest_block = std::min(block_width_, block_height_);
  truncation_distance_texels_ = std::min(std::max(1e5 * range, 16 * smallest_block), 1e6 * smallest_block);
  build();
}

EmbreeScene::~EmbreeScene() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

void EmbreeScene::build() {
  // One thread builds: the order of triangles in the tree decides ties between them, and must not depend on
  // the number of threads.
  device_ = rtcNewDevice("threads=1");
  if (device_ == nullptr) throw std::runtime_error("Embree finds no device");
  rtcSetDeviceErrorFunction(device_, ignore_embree_error, nullptr);
  scene_ = rtcNewScene(device_);
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);

  const int open_cells = wrap_ ? 0 : 1;
  const uint32_t columns = static_cast<uint32_t>(block_width_ + 2 * margin_ - open_cells);
  const uint32_t rows = static_cast<uint32_t>(block_height_ + 2 * margin_ - open_cells);
  scene_columns_ = columns;
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                              static_cast<size_t>(columns + 1) * (rows + 1)));
  auto* indices =
      static_cast<uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                     3 * sizeof(uint32_t), size_t{2} * columns * rows));
  if (vertices == nullptr || indices == nullptr) {
    rtcReleaseGeometry(geometry);
    throw std::bad_alloc();
  }
  fill_triangles(vertices, indices, columns, rows);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_);
  if (const RTCError error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE)
    throw std::runtime_error(
        fmt::format("Embree could not build the scene (error {})", static_cast<int>(error)));
}

// Fills the vertices of columns × rows cells, margin included, and the indices of their triangles.
void EmbreeScene::fill_triangles(float* vertices, uint32_t* indices, uint32_t columns, uint32_t rows) const {
  for (uint32_t j = 0; j <= rows; ++j) {
    for (uint32_t i = 0; i <= columns; ++i) {
      const int x = static_cast<int>(i) - margin_, y = static_cast<int>(j) - margin_;
      const int column = wrap_index(x, surface_.width()), row = wrap_index(y, surface_.height());
      // Embree leaves out triangles with a corner that is not finite.
      const double height_m = surface_.is_hole(column, row) ? std::numeric_limits<double>::quiet_NaN()
                                                            : surface_.heights_m(column, row);
      *vertices++ = static_cast<float>(x);
      *vertices++ = static_cast<float>(y);
      *vertices++ = static_cast<float>(height_m / surface_.texel_size_m);
    }
  }
  // Cut and corners in the order of surface/facets.h.
  for (uint32_t j = 0; j < rows; ++j) {
    for (uint32_t i = 0; i < columns; ++i) {
      const uint32_t corner = j * (columns + 1) + i;
      for (const uint32_t index : {corner, corner + 1, corner + columns + 1,  //
                                   corner + columns + 2, corner + columns + 1, corner + 1})
        *indices++ = index;
    }
  }
}

uint32_t EmbreeScene::facet_of_primitive(uint32_t primitive) const {
  const uint32_t cell = primitive / 2;
  const int x = static_cast<int>(cell % scene_columns_) - margin_,
            y = static_cast<int>(cell / scene_columns_) - margin_;
  if (!wrap_) return primitive;
  const int i = wrap_index(x, surface_.width()), j = wrap_index(y, surface_.height());
  return 2 * static_cast<uint32_t>(surface_.heights_m.index(i, j)) + primitive % 2;
}

// Follows one straight piece inside the scene. Hits of the ray's own facet, due to rounding on a steep wall,
// are passed through: a flat facet never sees itself.
RayOutcome EmbreeScene::follow_segment(const glm::vec3& start, const glm::vec3& direction, float length,
                                       uint32_t own_facet, SurfaceHit* hit) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query;
  RTCRay& ray = query.ray;
  ray.org_x = start.x;
  ray.org_y = start.y;
  ray.org_z = start.z;
  ray.dir_x = direction.x;
  ray.dir_y = direction.y;
  ray.dir_z = direction.z;
  ray.tnear = 0;
  ray.tfar = length;
  ray.time = 0;
  ray.mask = 0xffffffff;
  ray.id = 0;
  ray.flags = 0;
  if (hit == nullptr && !has_holes_) {
    rtcOccluded1(scene_, &context, &ray);
    return ray.tfar < 0 ? RayOutcome::kHit : RayOutcome::kEscaped;
  }
  for (;;) {
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return RayOutcome::kEscaped;
    const uint32_t facet = facet_of_primitive(query.hit.primID);
    if (facet != own_facet) {
      if (has_holes_ && glm::dot(facet_normal(surface_, facet), glm::dvec3(direction)) >= 0)
        return RayOutcome::kBelow;
      if (hit != nullptr) *hit = {facet, query.hit.u, query.hit.v, static_cast<double>(ray.tfar), 0};
      return RayOutcome::kHit;
    }
    ray.tnear = std::max(std::nextafter(ray.tfar, length), ray.tfar * 1.00001f);
    ray.tfar = length;
    if (ray.tnear >= length) return RayOutcome::kEscaped;
  }
}

// Returns the length of a ray from (x, y) to the end of block and margin, less one cell of overlap.
// In float: an error is far less than that cell. A direction of 0 along an axis never leaves along it
// (x / 0 = ∞, inside).
float EmbreeScene::length_in_block(float x, float y, const glm::vec3& direction) const {
  const float reach = static_cast<float>(margin_ - 1);
  const float edge_x = std::signbit(direction.x) ? -reach : static_cast<float>(block_width_) + reach;
  const float edge_y = std::signbit(direction.y) ? -reach : static_cast<float>(block_height_) + reach;
  return std::min((edge_x - x) / direction.x, (edge_y - y) / direction.y);
}

RayOutcome EmbreeScene::follow(const glm::vec3& start, const glm::vec3& direction, uint32_t own_facet,
                               SurfaceHit* hit) const {
  // The ray leaves the slab of the relief there. Rounded up: the highest texel itself can still be met.
  float end = max_distance_texels_;
  if (direction.z > 0) {
    const float climb = top_texels_ - start.z;
    if (climb <= 0) return RayOutcome::kEscaped;
    end = std::min(end, climb / direction.z * 1.0001f);
  } else if (has_holes_) {
    end = std::min(end, (start.z + 1) / -direction.z);  // below all of the surface
  }
  const float first_length = wrap_ ? std::min(end, length_in_block(start.x, start.y, direction)) : end;
  const RayOutcome outcome = follow_segment(start, direction, first_length, own_facet, hit);
  if (outcome == RayOutcome::kEscaped && ground_beyond_ && direction.z < 0)
    return has_holes_ && ends_below(start, direction) ? RayOutcome::kEscaped : RayOutcome::kGround;
  if (outcome == RayOutcome::kBelow) return RayOutcome::kEscaped;
  if (outcome == RayOutcome::kHit || first_length == end) return outcome;
  return follow_beyond(start, direction, first_length, end, own_facet, hit);
}

// Returns whether a ray that falls and meets nothing leaves the map below the surface: it came through a
// hole.
bool EmbreeScene::ends_below(const glm::vec3& start, const glm::vec3& direction) const {
  const double length_x = ((direction.x > 0 ? surface_.width() - 1 : 0) - start.x) / direction.x;
  const double length_y = ((direction.y > 0 ? surface_.height() - 1 : 0) - start.y) / direction.y;
  const double length =
      std::min(direction.x == 0 ? HUGE_VAL : length_x, direction.y == 0 ? HUGE_VAL : length_y);
  if (!std::isfinite(length)) return true;
  const glm::dvec3 border = glm::dvec3(start) + length * glm::dvec3(direction);
  const double x = std::clamp(border.x, 0.0, surface_.width() - 1.0),
               y = std::clamp(border.y, 0.0, surface_.height() - 1.0);
  const int i = std::min(static_cast<int>(x), surface_.width() - 2),
            j = std::min(static_cast<int>(y), surface_.height() - 2);
  const auto height = [&](int column, int row) {
    return static_cast<double>(surface_.heights_m(column, row)) / surface_.texel_size_m;
  };
  // Along a border the surface is linear between two texels.
  const double u = x - i, v = y - j;
  const double ground = (1 - u) * (1 - v) * height(i, j) + u * (1 - v) * height(i + 1, j) +
                        (1 - u) * v * height(i, j + 1) + u * v * height(i + 1, j + 1);
  return border.z < ground;
}

// Follows a ray through further copies of the map. Positions come from the start in double: nothing drifts.
RayOutcome EmbreeScene::follow_beyond(const glm::vec3& start, const glm::vec3& direction, double first_length,
                                      double end, uint32_t own_facet, SurfaceHit* hit) const {
  const double horizontal = std::hypot(direction.x, direction.y);
  const double truncation_distance = truncation_distance_texels_ / horizontal;
  // Each piece begins a little before the last one ended: rounding of its start opens no gap.
  const double overlap = 0.05 / horizontal;
  const double stop = std::min(end, truncation_distance);
  double travelled = first_length;
  for (int tiles = 1; travelled < stop; ++tiles) {
    const double begin = travelled - overlap;
    glm::dvec3 position = glm::dvec3(start) + begin * glm::dvec3(direction);
    position.x -= block_width_ * std::floor(position.x / block_width_);
    position.y -= block_height_ * std::floor(position.y / block_height_);
    const glm::vec3 piece_start(position);
    // Every piece but the last is a block long or more, so the loop ends.
    const double length = length_in_block(piece_start.x, piece_start.y, direction);
    travelled = begin + length;
    const float piece_length = static_cast<float>(std::min(length, stop - begin));
    const RayOutcome outcome = follow_segment(piece_start, direction, piece_length, own_facet, hit);
    if (outcome == RayOutcome::kBelow) return RayOutcome::kEscaped;
    if (outcome == RayOutcome::kHit) {
      if (hit != nullptr) {
        hit->distance_texels += begin;
        hit->tiles_crossed = tiles;
      }
      return RayOutcome::kHit;
    }
  }
  return end <= truncation_distance ? RayOutcome::kEscaped : RayOutcome::kTruncated;
}

}  // namespace hemibake
