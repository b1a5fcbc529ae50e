#include "tracers/slice/slice.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/parallel.h"
#include "sampling/low_discrepancy.h"
#include "tracers/hit_form_factors.h"
#include "tracers/slice/families.h"
#include "tracers/slice/height_pyramid.h"
#include "tracers/slice/packets.h"
#include "tracers/slice/replay.h"
#include "tracers/slice/traversal.h"
#include "tracers/slice/views.h"

namespace hemibake {
namespace {

// Hash streams, one per use, apart from those of the other tracers.
constexpr uint64_t kTexelSample = 0x511ce06, kNodeSample = 0x511ce07;

// Packets traced together: with form factors, their hits stay in the cache; without, more of them follow the
// same path.
constexpr size_t kNodePacketsTogether = 32, kTexelPacketsTogether = 1024, kTexelPacketsWithLinks = 16;

// Destination of the rows of a family's receivers.
struct RowTarget {
  const SlicePaths& paths;
  bool with_links;
  std::span<Row> rows;
  uint32_t first;                                   // receiver of rows[0]
  uint32_t map_width = 0xffffffff, tile_width = 0;  // of a tile's rows; default: one receiver after the other

  Row& row(uint32_t receiver) const {
    const uint32_t number = receiver - first;
    return rows[size_t{number / map_width} * tile_width + number % map_width];
  }
};

// Fills sky and direct light of a lane's row.
void fill_sky(const SliceReceivers& receivers, const PacketView& view, size_t lane, Row& row) {
  const glm::dvec3 sky(view.sky.x[lane], view.sky.y[lane], view.sky.z[lane]);
  // Over the unblocked hemisphere along the same azimuths: exactly 1 on open ground.
  row.visible_fraction = std::clamp(view.sky.uniform[lane] / view.hemisphere.uniform[lane], 0.0, 1.0);
  row.direct_over_pi = std::clamp(
      cosine_sum(receivers, view.sky, lane) / cosine_sum(receivers, view.hemisphere, lane), 0.0, 1.0);
  const double length = glm::length(sky);
  row.bent_normal =
      length > 0
          ? sky / length
          : glm::normalize(glm::dvec3(-receivers.tangent_slope_x[lane], -receivers.tangent_slope_y[lane], 1));
}

class SliceTracer final : public Tracer {
 public:
  SliceTracer(const Surface& surface, const SliceOptions& options)
      : scene_{surface, options, make_patches(surface, options.patch_kind), make_height_pyramid(surface),
               make_slice_families(options.azimuths, options.patch_kind, options.seed)} {}

  const Surface& surface() const override { return scene_.surface; }
  const PatchSet& patch_set() const override { return scene_.patch_set; }
  void trace_texel(uint32_t texel, bool with_links, Row& row, TracerCounts& counts) const override {
    trace_texels(texel, with_links, {&row, 1}, counts);
  }
  void trace_patch(uint32_t patch, bool with_links, Row& row, TracerCounts& counts) const override {
    trace_patches(patch, with_links, {&row, 1}, counts);
  }
  void trace_texels(uint32_t first, bool with_links, std::span<Row> rows,
                    TracerCounts& counts) const override;
  void trace_tile(const TexelTile& tile, std::span<Row> rows, TracerCounts& counts) const override;
  void trace_patches(uint32_t first, bool with_links, std::span<Row> rows,
                     TracerCounts& counts) const override;
  std::unique_ptr<Tracer> reseeded(uint64_t seed) const override {
    auto again = std::make_unique<SliceTracer>(*this);
    again->scene_.options.seed = seed;
    again->scene_.families = make_slice_families(scene_.options.azimuths, scene_.options.patch_kind, seed);
    return again;
  }
  std::vector<RayRecord> replay_texel(uint32_t texel) const override;

 private:
  void fill_rows(const RowTarget& target, const PacketList& list, TracerCounts& counts) const;
  void fill_form_factors(std::span<const SliceHit> hits, uint32_t receiver, uint32_t own_facet,
                         Row& row) const;

  SliceScene scene_;
};

// Fills the form factors of a row from its receiver's hits. own_facet: kNoFacet: a texel.
void SliceTracer::fill_form_factors(std::span<const SliceHit> hits, uint32_t receiver, uint32_t own_facet,
                                    Row& row) const {
  const uint64_t stream = own_facet == kNoFacet ? kTexelSample : kNodeSample;
  double u = unit_interval(mix_bits(scene_.options.seed, stream, receiver));
  // Rounding may leave a little of the own facet where a path leaves it at a corner.
  double blocked = 0;
  for (const SliceHit& hit : hits)
    if (hit.facet != own_facet) blocked += static_cast<double>(hit.weight);
  const double scale = blocked > 0 ? (1 - row.direct_over_pi) / blocked : 0;
  for (const SliceHit& hit : hits) {
    if (hit.facet == own_facet) continue;
    u = cranley_patterson_rotate(u, kGoldenStep);
    add_form_factors(scene_.surface, scene_.patch_set, scene_.options.texel_links,
                     {hit.facet, {hit.u, hit.v}, hit.distance, static_cast<double>(hit.weight) * scale}, u,
                     row.links);
  }
  // Only ground beyond the border blocks the rest.
  if (scene_.surface.edge == Edge::kGround && row.links.empty() && 1 - row.direct_over_pi >= kLeastBlocked)
    add_own_form_factor(scene_.surface, scene_.patch_set, receiver, own_facet != kNoFacet,
                        1 - row.direct_over_pi, row.links);
  complete_row(row);
}

// Traces packets and fills the wanted rows.
void SliceTracer::fill_rows(const RowTarget& target, const PacketList& list, TracerCounts& counts) const {
  const bool of_nodes = &target.paths != &scene_.families.texels;
  const size_t together = of_nodes            ? kNodePacketsTogether
                          : target.with_links ? kTexelPacketsWithLinks
                                              : kTexelPacketsTogether;
  const Query query = target.with_links ? Query::kSampledHits : Query::kHorizon;
  std::vector<SlicePacket> scratch;
  for (size_t begin = 0; begin < list.packets.size(); begin += together) {
    const SlicePackets piece = list.part(begin, std::min(together, list.packets.size() - begin), scratch);
    const std::span<const PacketView> views = trace_views(scene_, target.paths, query, piece);
    const WantedRows* wanted = &list.wanted[list.packets[begin].first_receiver];
    for (const SlicePacket& packet : piece.packets)
      for (size_t r = packet.first_receiver; r < packet.first_receiver + packet.receivers; ++r, ++wanted) {
        uint32_t receiver = wanted->first;
        for (uint32_t lanes = wanted->lanes; lanes != 0; lanes &= lanes - 1, ++receiver) {
          const auto lane = static_cast<uint32_t>(std::countr_zero(lanes));
          Row& row = target.row(receiver);
          fill_sky(piece.receivers[r], views[r], lane, row);
          row.links.clear();
          counts.rays += static_cast<uint64_t>(target.paths.azimuths);
          counts.truncated += views[r].truncated[lane];
          if (!target.with_links) continue;
          const uint32_t own_facet =
              of_nodes ? facet_of_slot(scene_.patch_set, wanted->slot, static_cast<uint32_t>(packet.x) + lane,
                                       static_cast<uint32_t>(packet.y))
                       : kNoFacet;
          fill_form_factors(views[r].hits[lane], receiver, own_facet, row);
        }
      }
  }
}

void SliceTracer::trace_texels(uint32_t first, bool with_links, std::span<Row> rows,
                               TracerCounts& counts) const {
  PacketList list;
  add_texels(scene_, first, static_cast<uint32_t>(rows.size()), list);
  fill_rows({scene_.families.texels, with_links, rows, first}, list, counts);
}

void SliceTracer::trace_tile(const TexelTile& tile, std::span<Row> rows, TracerCounts& counts) const {
  const uint32_t map_width = static_cast<uint32_t>(scene_.surface.width());
  const uint32_t first = tile.y * map_width + tile.x;
  PacketList list;
  for (uint32_t j = 0; j < tile.height; ++j) add_texels(scene_, first + j * map_width, tile.width, list);
  fill_rows({scene_.families.texels, false, rows, first, map_width, tile.width}, list, counts);
}

void SliceTracer::trace_patches(uint32_t first, bool with_links, std::span<Row> rows,
                                TracerCounts& counts) const {
  if (scene_.options.patch_kind == PatchKind::kTexels) return trace_texels(first, with_links, rows, counts);
  std::vector<PacketList> lists(kSites);
  add_nodes(scene_, first, static_cast<uint32_t>(rows.size()), lists);
  for (size_t site = 0; site < kSites; ++site)
    fill_rows({scene_.families.nodes[site], with_links, rows, first}, lists[site], counts);
}

std::vector<RayRecord> SliceTracer::replay_texel(uint32_t texel) const {
  const int x = static_cast<int>(texel) % surface().width(), y = static_cast<int>(texel) / surface().width();
  const int lane = x % kSliceLanes;
  const SlicePacket packet = texel_packet(scene_, x - lane, y);
  const SliceReceivers receivers = texel_receivers(scene_, x - lane, y);
  const std::span<const PacketView> views =
      trace_views(scene_, scene_.families.texels, Query::kAllIntervals, {{&packet, 1}, {&receivers, 1}});
  return replay_slices(surface(), scene_.families.texels, packet, receivers, views[0],
                       static_cast<size_t>(lane));
}

// Heights and max mips, with what making them takes.
constexpr size_t kPyramidBytesPerTexel = 8;
// Views and hits of the packets traced together.
constexpr size_t kBytesPerThread = size_t{2} << 20, kBytesPerThreadWithLinks = size_t{6} << 20;

}  // namespace

size_t slice_tracer_bytes(uint32_t texels, const SliceOptions& options, bool with_links) {
  const SliceFamilies families = make_slice_families(options.azimuths, options.patch_kind, options.seed);
  size_t bytes = kPyramidBytesPerTexel * texels + cache_bytes(families.texels);
  if (with_links)
    for (const SlicePaths& paths : families.nodes) bytes += cache_bytes(paths);
  return bytes +
         static_cast<size_t>(thread_count()) * (with_links ? kBytesPerThreadWithLinks : kBytesPerThread);
}

std::unique_ptr<Tracer> make_slice_tracer(const Surface& surface, const SliceOptions& options) {
  return std::make_unique<SliceTracer>(surface, options);
}

}  // namespace hemibake
