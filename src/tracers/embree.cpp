#include "tracers/embree.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <span>
#include <stdexcept>

#include "core/constants.h"
#include "sampling/low_discrepancy.h"
#include "sampling/warp.h"
#include "surface/facets.h"
#include "surface/frame.h"
#include "tracers/link_merge.h"

namespace hemibake {
namespace {

// The scene is in units of texels: vertices then stand on integers, which float holds exactly on any map we
// take.
constexpr int kSmallestBlock =
    64;                      // texels: smaller maps are repeated, so that a step to the next copy is worth it
constexpr int kMargin = 64;  // texels of neighbouring copies around the block
constexpr uint32_t kNoFacet = 0xffffffff;

// Hash streams, one per use.
constexpr uint64_t kTexelRotation = 1, kNodeRotation = 2, kNodeShiftU = 3, kNodeShiftV = 4, kTexelChoice = 5,
                   kNodeChoice = 6, kNodeElevation = 7;

enum class Fate { kSky, kHit, kCutShort };

struct SurfaceHit {
  uint32_t facet = kNoFacet;
  float u = 0, v = 0;          // barycentric coordinates of the facet's corners 1 and 2
  double distance_texels = 0;  // from the start of the ray
  int tiles_crossed = 0;
};

class EmbreeTracer final : public Tracer {
 public:
  EmbreeTracer(const Surface& surface, const RayOptions& options);
  EmbreeTracer(const EmbreeTracer& other, uint64_t seed);
  ~EmbreeTracer() override;

  const PatchSet& patches() const override { return patches_; }
  void trace_texel(uint32_t texel, bool with_links, Row& row, TracerCounts& counts) const override;
  void trace_patch(uint32_t patch, bool with_links, Row& row, TracerCounts& counts) const override;
  std::unique_ptr<Tracer> reseeded(uint64_t seed) const override {
    return std::make_unique<EmbreeTracer>(*this, seed);
  }
  std::vector<RayRecord> replay_texel(uint32_t texel) const override;

 private:
  // What nodes of one kind share.
  struct NodeRays {
    std::vector<glm::vec2> azimuths;  // unit, tangent plane, one per ray
    std::vector<glm::dvec2> points;   // in the unit square, one per ray
  };
  struct FloatFrame {
    glm::vec3 tangent, bitangent, normal;
    glm::vec3 world_from_tangent(const glm::vec3& v) const {
      return v.x * tangent + v.y * bitangent + v.z * normal;
    }
  };

  static NodeRays make_node_rays(int rays);
  EmbreeTracer(const EmbreeTracer&) = default;
  void build_scene();
  glm::vec3 texel_start(uint32_t texel) const;
  FloatFrame texel_frame(uint32_t texel) const;
  Fate follow(const glm::vec3& start, const glm::vec3& direction, uint32_t own_facet, SurfaceHit* hit) const;
  Fate follow_segment(const glm::vec3& start, const glm::vec3& direction, float length, uint32_t own_facet,
                      SurfaceHit* hit) const;
  Fate follow_beyond(const glm::vec3& start, const glm::vec3& direction, double first_length, double end,
                     uint32_t own_facet, SurfaceHit* hit) const;
  float length_in_block(float x, float y, const glm::vec3& direction) const;
  template <class StartOf>
  void trace_rays(std::span<const WeightedDirection> rays, const FloatFrame& frame, const StartOf& start_of,
                  uint32_t own_facet, double choice, bool with_links, Row& row, TracerCounts& counts) const;
  void add_links(const SurfaceHit& hit, double weight, double choice, bool of_node,
                 std::vector<Link>& links) const;
  void trace_node(uint32_t patch, bool with_links, Row& row, TracerCounts& counts) const;
  uint32_t facet_of_primitive(uint32_t primitive) const;
  glm::dvec2 hit_position_texels(const SurfaceHit& hit) const;

  const Surface& surface_;
  RayOptions options_;
  PatchSet patches_;
  std::vector<WeightedDirection> texel_directions_;
  std::array<NodeRays, kNodeKinds> node_rays_;  // by node_kind
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
  bool wrap_;
  int block_width_, block_height_;  // texels the scene repeats the map to
  int margin_;
  uint32_t scene_columns_;  // cells in a row of the scene
  float top_texels_;        // height of the highest texel
  float max_distance_texels_;
  double lift_texels_;
  double cut_distance_texels_;  // horizontal distance after which a ray is cut short
};

// Errors are asked for where they matter; an exception must not leave this callback.
void ignore_embree_error(void*, RTCError, const char*) {}

EmbreeTracer::EmbreeTracer(const Surface& surface, const RayOptions& options)
    : surface_(surface),
      options_(options),
      patches_(make_patches(surface, options.patches)),
      texel_directions_(make_directions(options.directions, options.rays, options.cone_degrees)),
      wrap_(surface.edge == Edge::kWrap) {
  const double range = height_range_m(surface) / surface.texel_size_m;
  top_texels_ = static_cast<float>(range);
  // A thousandth of a texel clears the rounding of the start; on a very low map the lift must not jump over
  // the relief, on a very high one it must clear the rounding of the heights.
  lift_texels_ = std::max(1e-3 * std::min(1.0, range), 0x1p-21 * range);
  max_distance_texels_ = static_cast<float>(options.max_distance_m / surface.texel_size_m);

  const int repeat_x = wrap_ ? (kSmallestBlock + surface.width() - 1) / surface.width() : 1;
  const int repeat_y = wrap_ ? (kSmallestBlock + surface.height() - 1) / surface.height() : 1;
  block_width_ = repeat_x * surface.width();
  block_height_ = repeat_y * surface.height();
  margin_ = wrap_ ? kMargin : 0;
  const double smallest_block = std::min(block_width_, block_height_);
  cut_distance_texels_ = std::min(std::max(1e5 * range, 16 * smallest_block), 1e6 * smallest_block);
  for (const int k : {kCoarseSubdivision, kFineSubdivision})
    for (const uint32_t node : {0u, 1u})
      node_rays_[node_kind(k, node)] = make_node_rays(rays_per_node(options.rays, k, node));
  build_scene();
}

EmbreeTracer::NodeRays EmbreeTracer::make_node_rays(int rays) {
  NodeRays result;
  for (uint32_t i = 0; i < static_cast<uint32_t>(rays); ++i) {
    const double azimuth = 2 * kPi * radical_inverse(2, i);
    result.azimuths.emplace_back(std::cos(azimuth), std::sin(azimuth));
    result.points.emplace_back(radical_inverse(3, i), radical_inverse(5, i));
  }
  return result;
}

EmbreeTracer::EmbreeTracer(const EmbreeTracer& other, uint64_t seed) : EmbreeTracer(other) {
  options_.seed = seed;
  rtcRetainDevice(device_);
  rtcRetainScene(scene_);
}

EmbreeTracer::~EmbreeTracer() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

void EmbreeTracer::build_scene() {
  // One thread builds: the order of triangles in the tree decides ties between them, and must not depend on
  // --threads.
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
  for (uint32_t j = 0; j <= rows; ++j) {
    for (uint32_t i = 0; i <= columns; ++i) {
      const int x = static_cast<int>(i) - margin_, y = static_cast<int>(j) - margin_;
      const double height_m =
          surface_.heights_m(wrap_index(x, surface_.width()), wrap_index(y, surface_.height()));
      *vertices++ = static_cast<float>(x);
      *vertices++ = static_cast<float>(y);
      *vertices++ = static_cast<float>(height_m / surface_.texel_size_m);
    }
  }
  // The same cut and the same order of corners as surface/facets.h.
  for (uint32_t j = 0; j < rows; ++j) {
    for (uint32_t i = 0; i < columns; ++i) {
      const uint32_t corner = j * (columns + 1) + i;
      for (const uint32_t index : {corner, corner + 1, corner + columns + 1,  //
                                   corner + columns + 2, corner + columns + 1, corner + 1})
        *indices++ = index;
    }
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_);
  if (const RTCError error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE)
    throw std::runtime_error(
        fmt::format("Embree could not build the scene (error {})", static_cast<int>(error)));
}

uint32_t EmbreeTracer::facet_of_primitive(uint32_t primitive) const {
  const uint32_t cell = primitive / 2;
  const int x = static_cast<int>(cell % scene_columns_) - margin_,
            y = static_cast<int>(cell / scene_columns_) - margin_;
  if (!wrap_) return primitive;
  const int i = wrap_index(x, surface_.width()), j = wrap_index(y, surface_.height());
  return 2 * static_cast<uint32_t>(surface_.heights_m.index(i, j)) + primitive % 2;
}

glm::dvec2 EmbreeTracer::hit_position_texels(const SurfaceHit& hit) const {
  return facet_point_texels(surface_, hit.facet, {hit.u, hit.v});
}

// Traces one straight piece inside the scene; on a hit of the ray's own facet (rounding on a steep wall) it
// goes on behind it: a flat facet never sees itself.
Fate EmbreeTracer::follow_segment(const glm::vec3& start, const glm::vec3& direction, float length,
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
  if (hit == nullptr) {
    rtcOccluded1(scene_, &context, &ray);
    return ray.tfar < 0 ? Fate::kHit : Fate::kSky;
  }
  for (;;) {
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return Fate::kSky;
    const uint32_t facet = facet_of_primitive(query.hit.primID);
    if (facet != own_facet) {
      *hit = {facet, query.hit.u, query.hit.v, static_cast<double>(ray.tfar), 0};
      return Fate::kHit;
    }
    ray.tnear = std::max(std::nextafter(ray.tfar, length), ray.tfar * 1.00001f);
    ray.tfar = length;
    if (ray.tnear >= length) return Fate::kSky;
  }
}

// Length along a ray from (x, y) until it leaves the block and the margin, less one cell kept as overlap. In
// float: an error is far less than that cell. A direction of 0 along an axis never leaves along it (x / 0 =
// ∞, inside).
float EmbreeTracer::length_in_block(float x, float y, const glm::vec3& direction) const {
  const float reach = static_cast<float>(margin_ - 1);
  const float edge_x = std::signbit(direction.x) ? -reach : static_cast<float>(block_width_) + reach;
  const float edge_y = std::signbit(direction.y) ? -reach : static_cast<float>(block_height_) + reach;
  return std::min((edge_x - x) / direction.x, (edge_y - y) / direction.y);
}

Fate EmbreeTracer::follow(const glm::vec3& start, const glm::vec3& direction, uint32_t own_facet,
                          SurfaceHit* hit) const {
  // Where the ray has left the slab of the relief. Rounded up: the highest texel itself can still be met.
  float end = max_distance_texels_;
  if (direction.z > 0) {
    const float climb = top_texels_ - start.z;
    if (climb <= 0) return Fate::kSky;
    end = std::min(end, climb / direction.z * 1.0001f);
  }
  const float first_length = wrap_ ? std::min(end, length_in_block(start.x, start.y, direction)) : end;
  const Fate fate = follow_segment(start, direction, first_length, own_facet, hit);
  if (fate == Fate::kHit || first_length == end) return fate;
  return follow_beyond(start, direction, first_length, end, own_facet, hit);
}

// Goes on through the following copies of the map. Positions come from the start in double, so that nothing
// drifts.
Fate EmbreeTracer::follow_beyond(const glm::vec3& start, const glm::vec3& direction, double first_length,
                                 double end, uint32_t own_facet, SurfaceHit* hit) const {
  const double horizontal = std::hypot(direction.x, direction.y);
  const double cut = cut_distance_texels_ / horizontal;
  // Each piece begins a little before the last one ended: rounding of its start opens no gap.
  const double overlap = 0.05 / horizontal;
  const double stop = std::min(end, cut);
  double travelled = first_length;
  for (int tiles = 1; travelled < stop; ++tiles) {
    const double begin = travelled - overlap;
    glm::dvec3 position = glm::dvec3(start) + begin * glm::dvec3(direction);
    position.x -= block_width_ * std::floor(position.x / block_width_);
    position.y -= block_height_ * std::floor(position.y / block_height_);
    const glm::vec3 piece_start(position);
    // A piece is a block long or more but for the last one, so this comes to an end.
    const double length = length_in_block(piece_start.x, piece_start.y, direction);
    travelled = begin + length;
    const float piece_length = static_cast<float>(std::min(length, stop - begin));
    if (follow_segment(piece_start, direction, piece_length, own_facet, hit) == Fate::kHit) {
      if (hit != nullptr) {
        hit->distance_texels += begin;
        hit->tiles_crossed = tiles;
      }
      return Fate::kHit;
    }
  }
  return end <= cut ? Fate::kSky : Fate::kCutShort;
}

glm::vec3 EmbreeTracer::texel_start(uint32_t texel) const {
  const int x = static_cast<int>(texel) % surface_.width(), y = static_cast<int>(texel) / surface_.width();
  const double z = static_cast<float>(surface_.heights_m[texel] / surface_.texel_size_m);
  return {x, y, z + lift_texels_};
}

EmbreeTracer::FloatFrame EmbreeTracer::texel_frame(uint32_t texel) const {
  const double turn = 2 * kPi * unit_interval(mix_bits(options_.seed, kTexelRotation, texel));
  const Frame frame = rotated(frame_about(glm::dvec3(surface_.normals[texel])), turn);
  return {frame.tangent, frame.bitangent, frame.normal};
}

// Nodes alone can meet only each other for ever (add_node_links): a texel draws one node however near it is.
void EmbreeTracer::add_links(const SurfaceHit& hit, double weight, double choice, bool of_node,
                             std::vector<Link>& links) const {
  if (options_.patches == Patches::kFacets) {
    const double distance = of_node ? hit.distance_texels : std::numeric_limits<double>::infinity();
    add_node_links(patches_, hit.facet, {hit.u, hit.v}, distance, choice, weight, links);
  } else if (options_.texel_links == TexelLinks::kNearest) {
    add_nearest_link(surface_, hit_position_texels(hit), weight, links);
  } else {
    add_bilinear_links(surface_, hit_position_texels(hit), weight, links);
  }
}

// start_of(i): where ray i starts, texels, already lifted. choice: in [0, 1), which node the first hit draws.
template <class StartOf>
void EmbreeTracer::trace_rays(std::span<const WeightedDirection> rays, const FloatFrame& frame,
                              const StartOf& start_of, uint32_t own_facet, double choice, bool with_links,
                              Row& row, TracerCounts& counts) const {
  double visible = 0, direct = 0;
  glm::dvec3 bent(0);
  size_t hits = 0;
  row.links.clear();
  SurfaceHit hit;
  for (size_t i = 0; i < rays.size(); ++i) {
    const glm::vec3 direction = frame.world_from_tangent(rays[i].local);
    const Fate fate = follow(start_of(i), direction, own_facet, with_links ? &hit : nullptr);
    if (fate == Fate::kHit) {
      ++hits;
      choice = shift_modulo_one(choice, kGoldenStep);
      if (with_links) add_links(hit, rays[i].cosine_weight, choice, own_facet != kNoFacet, row.links);
    } else {
      visible += rays[i].uniform_weight;
      direct += rays[i].cosine_weight;
      bent += rays[i].uniform_weight * glm::dvec3(direction);
      counts.cut_short += fate == Fate::kCutShort;
    }
  }
  counts.rays += rays.size();
  // Exactly 1 on open ground and exactly 0 in the dark, whatever the weights round to.
  const bool all_sky = hits == 0, no_sky = hits == rays.size();
  row.visible_fraction = all_sky ? 1 : no_sky ? 0 : std::min(1.0, visible);
  row.direct_over_pi = all_sky ? 1 : no_sky ? 0 : std::min(1.0, direct);
  const double length = glm::length(bent);
  row.bent_normal = length > 1e-6 ? bent / length : glm::dvec3(frame.normal);
  if (with_links) merge_links(row);
}

void EmbreeTracer::trace_texel(uint32_t texel, bool with_links, Row& row, TracerCounts& counts) const {
  const glm::vec3 start = texel_start(texel);
  const double choice = unit_interval(mix_bits(options_.seed, kTexelChoice, texel));
  trace_rays(
      texel_directions_, texel_frame(texel), [&](size_t) { return start; }, kNoFacet, choice, with_links, row,
      counts);
}

void EmbreeTracer::trace_patch(uint32_t patch, bool with_links, Row& row, TracerCounts& counts) const {
  if (options_.patches == Patches::kTexels) return trace_texel(patch, with_links, row, counts);
  trace_node(patch, with_links, row, counts);
}

void EmbreeTracer::trace_node(uint32_t patch, bool with_links, Row& row, TracerCounts& counts) const {
  const FacetNode node = facet_node(patches_, patch);
  const NodeRays& set = node_rays_[node_kind(node.subdivision, node.node)];
  const auto random = [&](uint64_t stream) { return unit_interval(mix_bits(options_.seed, stream, patch)); };

  const auto corners = facet_positions_texels(surface_, node.facet);
  const double leg = node.facet % 2 == 0 ? 1 : -1;
  const double slope_x = leg * (corners[1].z - corners[0].z), slope_y = leg * (corners[2].z - corners[0].z);
  const double shift_u = random(kNodeShiftU), shift_v = random(kNodeShiftV);
  const auto start_of = [&](size_t i) {
    const glm::dvec2 point = sample_uniform_triangle(
        {shift_modulo_one(set.points[i].x, shift_u), shift_modulo_one(set.points[i].y, shift_v)});
    const glm::dvec2 uv = node_start_uv(node.node, point);
    // The height is taken at the rounded position: on a steep wall that rounding is more than the lift.
    const float x = static_cast<float>(corners[0].x + leg * uv.x),
                y = static_cast<float>(corners[0].y + leg * uv.y);
    const double z = corners[0].z + slope_x * (x - corners[0].x) + slope_y * (y - corners[0].y);
    return glm::vec3(x, y, z + lift_texels_);
  };

  // Cosine-distributed, shifted in elevation too: a few rays at the same elevations everywhere would miss the
  // same low blockers at every node.
  thread_local std::vector<WeightedDirection> rays;  // scratch
  rays.resize(set.azimuths.size());
  const double count = static_cast<double>(rays.size()), shift = random(kNodeElevation);
  for (size_t i = 0; i < rays.size(); ++i) {
    const double sin2 = (static_cast<double>(i) + shift) / count;
    const glm::vec2 horizontal = static_cast<float>(std::sqrt(sin2)) * set.azimuths[i];
    rays[i] = {{horizontal.x, horizontal.y, std::sqrt(1 - sin2)}, 1 / count, 1 / count};
  }
  const Frame frame =
      rotated(frame_about(facet_normal(surface_, node.facet)), 2 * kPi * random(kNodeRotation));
  trace_rays(rays, {frame.tangent, frame.bitangent, frame.normal}, start_of, node.facet, random(kNodeChoice),
             with_links, row, counts);
}

std::vector<RayRecord> EmbreeTracer::replay_texel(uint32_t texel) const {
  const glm::vec3 start = texel_start(texel);
  const FloatFrame frame = texel_frame(texel);
  std::vector<RayRecord> records;
  for (const WeightedDirection& ray : texel_directions_) {
    const glm::vec3 direction = frame.world_from_tangent(ray.local);
    SurfaceHit hit;
    RayRecord record{glm::dvec3(direction), ray.cosine_weight, ray.uniform_weight, false, 0, {0, 0}, 0, 0};
    if (follow(start, direction, kNoFacet, &hit) == Fate::kHit) {
      record.hit = true;
      record.facet = hit.facet;
      record.hit_texel = hit_position_texels(hit);
      record.distance_m = hit.distance_texels * surface_.texel_size_m;
      record.tiles_crossed = hit.tiles_crossed;
    }
    records.push_back(record);
  }
  return records;
}

}  // namespace

std::unique_ptr<Tracer> make_embree_tracer(const Surface& surface, const RayOptions& options) {
  return std::make_unique<EmbreeTracer>(surface, options);
}

size_t embree_scene_bytes(const Surface& surface) {
  // Vertices 12, indices 24 and the tree about 90 bytes a facet; measured 512² to 4096², with 10 % to spare.
  return size_t{facet_count(surface)} * 130 + (size_t{1} << 20);
}

}  // namespace hemibake
