#include "tracers/embree/embree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <span>

#include "core/constants.h"
#include "sampling/low_discrepancy.h"
#include "sampling/warp.h"
#include "surface/facets.h"
#include "surface/frame.h"
#include "tracers/embree/scene.h"
#include "tracers/link_merge.h"

namespace hemibake {
namespace {

// Hash streams, one per use.
constexpr uint64_t kTexelRotation = 1, kNodeRotation = 2, kNodeShiftU = 3, kNodeShiftV = 4, kTexelChoice = 5,
                   kNodeChoice = 6, kNodeElevation = 7;

class EmbreeTracer final : public Tracer {
 public:
  EmbreeTracer(const Surface& surface, const RayOptions& options);

  const Surface& surface() const override { return surface_; }
  const PatchSet& patch_set() const override { return patches_; }
  void trace_texel(uint32_t texel, bool with_links, Row& row, TracerCounts& counts) const override;
  void trace_patch(uint32_t patch, bool with_links, Row& row, TracerCounts& counts) const override;
  std::unique_ptr<Tracer> reseeded(uint64_t seed) const override {
    auto again = std::make_unique<EmbreeTracer>(*this);
    again->options_.seed = seed;
    return again;
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
  glm::vec3 texel_start(uint32_t texel) const;
  FloatFrame texel_frame(uint32_t texel) const;
  template <class StartOf>
  void trace_rays(std::span<const WeightedDirection> rays, const FloatFrame& frame, const StartOf& start_of,
                  uint32_t own_facet, double choice, bool with_links, Row& row, TracerCounts& counts) const;
  void add_links(const SurfaceHit& hit, double weight, double choice, bool of_node,
                 std::vector<FormFactor>& links) const;
  void trace_node(uint32_t patch, bool with_links, Row& row, TracerCounts& counts) const;
  glm::dvec2 hit_position_texels(const SurfaceHit& hit) const;

  const Surface& surface_;
  RayOptions options_;
  PatchSet patches_;
  std::vector<WeightedDirection> texel_directions_;
  std::array<NodeRays, kNodeKinds> node_rays_;  // by node_kind
  std::shared_ptr<const EmbreeScene> scene_;
  double lift_texels_;
};

EmbreeTracer::EmbreeTracer(const Surface& surface, const RayOptions& options)
    : surface_(surface),
      options_(options),
      patches_(make_patches(surface, options.patch_kind)),
      texel_directions_(make_directions(options.directions, options.rays, options.cone_degrees)),
      scene_(std::make_shared<EmbreeScene>(surface, options.max_distance_m)) {
  const double range = height_range_m(surface) / surface.texel_size_m;
  // A thousandth of a texel clears the rounding of the start; on a very low map the lift must not jump over
  // the relief, on a very high one it must clear the rounding of the heights.
  lift_texels_ = std::max(1e-3 * std::min(1.0, range), 0x1p-21 * range);
  for (const int k : {kCoarseSubdivision, kFineSubdivision})
    for (const uint32_t node : {node_at(k, 0, 0), node_at(k, 1, 0)})
      node_rays_[node_kind(k, node)] = make_node_rays(rays_per_node(options.rays, k, node));
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

glm::dvec2 EmbreeTracer::hit_position_texels(const SurfaceHit& hit) const {
  return facet_point_texels(surface_, hit.facet, {hit.u, hit.v});
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
                             std::vector<FormFactor>& links) const {
  if (options_.patch_kind == PatchKind::kFacets) {
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
    const RayOutcome fate = scene_->follow(start_of(i), direction, own_facet, with_links ? &hit : nullptr);
    if (fate == RayOutcome::kHit) {
      ++hits;
      choice = cranley_patterson_rotate(choice, kGoldenStep);
      if (with_links) add_links(hit, rays[i].cosine_weight, choice, own_facet != kNoFacet, row.links);
    } else {
      visible += rays[i].uniform_weight;
      direct += rays[i].cosine_weight;
      bent += rays[i].uniform_weight * glm::dvec3(direction);
      counts.truncated += fate == RayOutcome::kTruncated;
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
  if (options_.patch_kind == PatchKind::kTexels) return trace_texel(patch, with_links, row, counts);
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
    const glm::dvec2 point = sample_uniform_triangle({cranley_patterson_rotate(set.points[i].x, shift_u),
                                                      cranley_patterson_rotate(set.points[i].y, shift_v)});
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
    if (scene_->follow(start, direction, kNoFacet, &hit) == RayOutcome::kHit) {
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
