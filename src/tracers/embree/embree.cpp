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
#include "tracers/hit_form_factors.h"

namespace hemibake {
namespace {

// Hash streams, one per use.
constexpr uint64_t kTexelRotation = 1, kNodeRotation = 2, kNodeShiftU = 3, kNodeShiftV = 4, kTexelSample = 5,
                   kNodeSample = 6, kNodeElevation = 7;

class EmbreeTracer final : public Tracer {
 public:
  EmbreeTracer(const Surface& surface, const RayOptions& options);

  const Surface& surface() const override { return surface_; }
  const PatchSet& patch_set() const override { return patch_set_; }
  void trace_texel(uint32_t texel, bool with_links, Row& row, TracerCounts& counts) const override;
  void trace_patch(uint32_t patch, bool with_links, Row& row, TracerCounts& counts) const override;
  std::unique_ptr<Tracer> reseeded(uint64_t seed) const override {
    auto again = std::make_unique<EmbreeTracer>(*this);
    again->options_.seed = seed;
    return again;
  }
  std::vector<RayRecord> replay_texel(uint32_t texel) const override;

 private:
  // Rays that all nodes of one kind share.
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

  struct Receiver {
    FloatFrame frame;
    uint32_t index;      // texel or patch
    uint32_t own_facet;  // kNoFacet: a texel
    double u;            // in [0, 1): draws the node of the first hit
  };

  static NodeRays make_node_rays(int rays);
  glm::vec3 texel_start(uint32_t texel) const;
  FloatFrame texel_frame(uint32_t texel) const;
  template <class StartOf>
  void trace_rays(const Receiver& receiver, std::span<const WeightedDirection> rays, const StartOf& start_of,
                  bool with_links, Row& row, TracerCounts& counts) const;
  void spread_ground(const Receiver& receiver, Row& row) const;

  const Surface& surface_;
  RayOptions options_;
  PatchSet patch_set_;
  std::vector<WeightedDirection> texel_directions_;
  std::array<NodeRays, kNodeKinds> node_rays_;  // by node_kind
  std::shared_ptr<const EmbreeScene> scene_;
  double lift_texels_;
};

EmbreeTracer::EmbreeTracer(const Surface& surface, const RayOptions& options)
    : surface_(surface),
      options_(options),
      patch_set_(make_patches(surface, options.patch_kind)),
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

glm::vec3 EmbreeTracer::texel_start(uint32_t texel) const {
  const glm::dvec3 center = texel_position_texels(surface_, texel);
  return {center.x, center.y, static_cast<float>(center.z) + lift_texels_};
}

EmbreeTracer::FloatFrame EmbreeTracer::texel_frame(uint32_t texel) const {
  const double rotation = 2 * kPi * unit_interval(mix_bits(options_.seed, kTexelRotation, texel));
  const Frame frame = rotated(frame_about(glm::dvec3(surface_.normals[texel])), rotation);
  return {frame.tangent, frame.bitangent, frame.normal};
}

// Traces one receiver's rays. start_of(i): start of ray i, texels, already lifted.
template <class StartOf>
void EmbreeTracer::trace_rays(const Receiver& receiver, std::span<const WeightedDirection> rays,
                              const StartOf& start_of, bool with_links, Row& row,
                              TracerCounts& counts) const {
  // Nodes alone can meet only each other for ever: a texel draws one node however near it is.
  const bool is_texel = receiver.own_facet == kNoFacet;
  double visible = 0, direct = 0, u = receiver.u;
  glm::dvec3 bent(0);
  size_t hits = 0;
  row.links.clear();
  SurfaceHit hit;
  for (size_t i = 0; i < rays.size(); ++i) {
    const glm::vec3 direction = receiver.frame.world_from_tangent(rays[i].local);
    const RayOutcome outcome =
        scene_->follow(start_of(i), direction, receiver.own_facet, with_links ? &hit : nullptr);
    if (outcome == RayOutcome::kHit) {
      ++hits;
      u = cranley_patterson_rotate(u, kGoldenStep);
      if (!with_links) continue;
      const double distance = is_texel ? std::numeric_limits<double>::infinity() : hit.distance_texels;
      add_form_factors(surface_, patch_set_, options_.texel_links,
                       {hit.facet, {hit.u, hit.v}, distance, rays[i].cosine_weight}, u, row.links);
    } else if (outcome == RayOutcome::kGround) {
      ++hits;
    } else {
      visible += rays[i].uniform_weight;
      direct += rays[i].cosine_weight;
      bent += rays[i].uniform_weight * glm::dvec3(direction);
      counts.truncated += outcome == RayOutcome::kTruncated;
    }
  }
  counts.rays += rays.size();
  // Exactly 1 on open ground and exactly 0 in the dark, whatever the weights round to.
  const bool all_sky = hits == 0, no_sky = hits == rays.size();
  row.visible_fraction = all_sky ? 1 : no_sky ? 0 : std::min(1.0, visible);
  row.direct_over_pi = all_sky ? 1 : no_sky ? 0 : std::min(1.0, direct);
  const double length = glm::length(bent);
  row.bent_normal = length > 1e-6 ? bent / length : glm::dvec3(receiver.frame.normal);
  if (!with_links) return;
  if (surface_.edge == Edge::kGround && hits > 0) spread_ground(receiver, row);
  complete_row(row);
}

// Gives the share of the ground beyond the border to the links, or to the receiver where it has none.
void EmbreeTracer::spread_ground(const Receiver& receiver, Row& row) const {
  const double blocked = 1 - row.direct_over_pi;
  if (row.links.empty())
    return add_own_form_factor(surface_, patch_set_, receiver.index, receiver.own_facet != kNoFacet, blocked,
                               row.links);
  double met = 0;
  for (const FormFactor& link : row.links) met += static_cast<double>(link.weight);
  for (FormFactor& link : row.links) link.weight *= static_cast<float>(blocked / met);
}

// What is no surface has the row of open ground.
void set_open_row(Row& row) {
  row.visible_fraction = row.direct_over_pi = 1;
  row.bent_normal = {0, 0, 1};
  row.links.clear();
}

void EmbreeTracer::trace_texel(uint32_t texel, bool with_links, Row& row, TracerCounts& counts) const {
  if (surface_.is_hole(texel)) return set_open_row(row);
  const glm::vec3 start = texel_start(texel);
  const double u = unit_interval(mix_bits(options_.seed, kTexelSample, texel));
  trace_rays(
      {texel_frame(texel), texel, kNoFacet, u}, texel_directions_, [&](size_t) { return start; }, with_links,
      row, counts);
}

void EmbreeTracer::trace_patch(uint32_t patch, bool with_links, Row& row, TracerCounts& counts) const {
  if (options_.patch_kind == PatchKind::kTexels) return trace_texel(patch, with_links, row, counts);
  const FacetNode node = facet_node(patch_set_, patch);
  if (facet_is_open(surface_, node.facet)) return set_open_row(row);
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

  // Cosine-distributed, shifted in elevation too: at the same few elevations every node would miss the same
  // low blockers.
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
  trace_rays({{frame.tangent, frame.bitangent, frame.normal}, patch, node.facet, random(kNodeSample)}, rays,
             start_of, with_links, row, counts);
}

std::vector<RayRecord> EmbreeTracer::replay_texel(uint32_t texel) const {
  const glm::vec3 start = texel_start(texel);
  const FloatFrame frame = texel_frame(texel);
  std::vector<RayRecord> records;
  for (const WeightedDirection& ray : texel_directions_) {
    const glm::vec3 direction = frame.world_from_tangent(ray.local);
    SurfaceHit hit;
    RayRecord record{glm::dvec3(direction), ray.cosine_weight, ray.uniform_weight, false, 0, {}, 0, 0};
    const RayOutcome outcome = scene_->follow(start, direction, kNoFacet, &hit);
    if (outcome == RayOutcome::kGround) continue;  // neither sky nor a facet
    if (outcome == RayOutcome::kHit) {
      record.hit = true;
      record.facet = hit.facet;
      record.hit_texel = facet_point_texels(surface_, hit.facet, {hit.u, hit.v});
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

size_t embree_scene_bytes(uint32_t facets) {
  // Vertices 12, indices 24 and the tree about 90 bytes a facet, and some to spare.
  return size_t{facets} * 130 + (size_t{1} << 20);
}

}  // namespace hemibake
