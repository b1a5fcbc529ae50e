#include "tracers/slice/packets.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "sampling/low_discrepancy.h"

namespace hemibake {
namespace {

// Hash streams, one per use, apart from those of the other tracers.
constexpr uint64_t kTexelRotation = 0x511ce01, kNodeRotation = 0x511ce03, kTexelHitOffset = 0x511ce04,
                   kNodeHitOffset = 0x511ce05;

// Hits of a slice that holds the mean share of its receiver's hemisphere. Nodes take fewer: a texel gathers
// from many of them.
constexpr double kTexelHits = kHitsPerSlice, kNodeHits = 1.5;

static_assert(kSliceLanes == kRunTexels && kMostReceivers == kMostAtSite);

// Returns the lowest `count` of the set bits, or all of them.
uint32_t first_bits(uint32_t bits, uint32_t count) {
  uint32_t others = bits;
  for (; count > 0 && others != 0; --count) others &= others - 1;
  return bits & ~others;
}

int draw_rotation(const SliceScene& scene, const SlicePaths& paths, uint64_t stream, uint64_t index) {
  return static_cast<int>(unit_interval(mix_bits(scene.options.seed, stream, index)) * paths.rotations);
}

// Sets how many hits slices are sampled at, and the offset of the first. The mean weight of a receiver's
// slices is half the secant of its tilt. index: of the hash, of lane 0.
void set_hit_sampling(uint64_t seed, double per_slice, uint64_t stream, uint64_t index,
                      SliceReceivers& receivers) {
  for (uint64_t lane = 0; lane < kSliceLanes; ++lane) {
    const double x = static_cast<double>(receivers.tangent_slope_x[lane]),
                 y = static_cast<double>(receivers.tangent_slope_y[lane]);
    receivers.hits_per_weight[lane] = static_cast<float>(2 * per_slice / std::sqrt(1 + x * x + y * y));
    receivers.hit_offset[lane] = static_cast<float>(unit_interval(mix_bits(seed, stream, index + lane)));
  }
}

// Returns the packet of a run's nodes at one site.
SlicePacket node_packet(const SliceScene& scene, const PatchRun& run, uint32_t site) {
  const NodeSite& place = kNodeSites.sites[site];
  // Inside a facet its own plane holds the start, on an edge that of either side.
  const int corner = place.slots == 1 ? kNodeSites.slots[place.first_slot].half : 0;
  SlicePacket packet;
  packet.x = static_cast<int>(run.x);
  packet.y = static_cast<int>(run.y);
  packet.rotation =
      draw_rotation(scene, scene.families.nodes[site], kNodeRotation, uint64_t{run.first} * kSites + site);
  packet.corner = static_cast<float>(corner);
  packet.receivers = place.slots;
  for (int lane = 0; lane < static_cast<int>(run.texels); ++lane) {
    const size_t l = static_cast<size_t>(lane);
    const auto height = [&](int dx, int dy) {
      return *scene.pyramid.heights.at(packet.x + lane + dx, packet.y + dy);
    };
    packet.base[l] = height(corner, corner) + static_cast<float>(scene.options.lift_texels);
    packet.plane_x[l] = height(1, corner) - height(0, corner);
    packet.plane_y[l] = height(corner, 1) - height(corner, 0);
  }
  return packet;
}

// Returns the nodes of one slot of a run.
SliceReceivers node_receivers(const SliceScene& scene, const PatchRun& run, uint32_t slot) {
  const NodeSlot& node = kNodeSites.slots[slot];
  const int half = node.half;
  SliceReceivers receivers;
  receivers.lanes = run.texels_with(slot);
  for (int lane = 0; lane < static_cast<int>(run.texels); ++lane) {
    const size_t l = static_cast<size_t>(lane);
    if ((receivers.lanes >> lane & 1) == 0) continue;
    const auto height = [&](int dx, int dy) {
      return *scene.pyramid.heights.at(static_cast<int>(run.x) + lane - node.left + dx,
                                       static_cast<int>(run.y) - node.up + dy);
    };
    // The legs of the right angle run along x and y, towards the cell's other side.
    receivers.tangent_slope_x[l] = height(1, half) - height(0, half);
    receivers.tangent_slope_y[l] = height(half, 1) - height(half, 0);
  }
  set_hit_sampling(scene.options.seed, kNodeHits, kNodeHitOffset, uint64_t{run.first_of(slot)} * kSliceLanes,
                   receivers);
  return receivers;
}

// Adds the packet of a run's nodes at one site, if any of them is among the patches begin … end − 1.
void add_site(const SliceScene& scene, const PatchRun& run, uint32_t site, uint32_t begin, uint32_t end,
              PacketList& list) {
  const NodeSite& place = kNodeSites.sites[site];
  std::array<WantedRows, kMostAtSite> wanted{};
  bool any = false;
  for (uint32_t i = 0; i < place.slots; ++i) {
    const uint32_t slot = place.first_slot + i, lanes = run.texels_with(slot), first = run.first_of(slot);
    const uint32_t here = std::max(first, begin);
    const uint32_t before = first_bits(lanes, here - first);
    wanted[i] = {end > here ? first_bits(lanes & ~before, end - here) : 0, here, slot};
    any = any || wanted[i].lanes != 0;
  }
  if (!any) return;
  SlicePacket packet = node_packet(scene, run, site);
  packet.first_receiver = static_cast<uint32_t>(list.receivers.size());
  list.packets.push_back(packet);
  for (uint32_t i = 0; i < place.slots; ++i) {
    list.receivers.push_back(node_receivers(scene, run, place.first_slot + i));
    list.wanted.push_back(wanted[i]);
  }
}

}  // namespace

SlicePackets PacketList::part(size_t first, size_t count, std::vector<SlicePacket>& scratch) const {
  scratch.assign(packets.begin() + static_cast<std::ptrdiff_t>(first),
                 packets.begin() + static_cast<std::ptrdiff_t>(first + count));
  const uint32_t begin = scratch.front().first_receiver;
  for (SlicePacket& packet : scratch) packet.first_receiver -= begin;
  const size_t end = packets[first + count - 1].first_receiver + packets[first + count - 1].receivers;
  return {scratch, std::span(receivers).subspan(begin, end - begin)};
}

SlicePacket texel_packet(const SliceScene& scene, int x, int y) {
  SlicePacket packet;
  packet.x = x;
  packet.y = y;
  packet.rotation =
      draw_rotation(scene, scene.families.texels, kTexelRotation, scene.surface.heights_m.index(x, y));
  const int lanes = std::min(kSliceLanes, scene.surface.width() - x);
  for (int lane = 0; lane < lanes; ++lane)
    packet.base[static_cast<size_t>(lane)] =
        *scene.pyramid.heights.at(x + lane, y) + static_cast<float>(scene.options.lift_texels);
  return packet;
}

SliceReceivers texel_receivers(const SliceScene& scene, int x, int y) {
  SliceReceivers receivers;
  const int lanes = std::min(kSliceLanes, scene.surface.width() - x);
  receivers.lanes = (1u << lanes) - 1;
  for (int lane = 0; lane < lanes; ++lane) {
    const size_t l = static_cast<size_t>(lane);
    const glm::vec3& n = scene.surface.normals(x + lane, y);
    receivers.tangent_slope_x[l] = -n.x / n.z;
    receivers.tangent_slope_y[l] = -n.y / n.z;
  }
  set_hit_sampling(scene.options.seed, kTexelHits, kTexelHitOffset, scene.surface.heights_m.index(x, y),
                   receivers);
  return receivers;
}

void add_texels(const SliceScene& scene, uint32_t first, uint32_t count, PacketList& list) {
  const uint32_t width = static_cast<uint32_t>(scene.surface.width()), end = first + count;
  for (uint32_t texel = first; texel < end;) {
    const int x = static_cast<int>(texel % width), y = static_cast<int>(texel / width),
              lane = x % kSliceLanes;
    SlicePacket packet = texel_packet(scene, x - lane, y);
    packet.first_receiver = static_cast<uint32_t>(list.receivers.size());
    list.packets.push_back(packet);
    list.receivers.push_back(texel_receivers(scene, x - lane, y));
    const uint32_t lanes = first_bits(list.receivers.back().lanes >> lane, end - texel) << lane;
    list.wanted.push_back({lanes, texel, kNoSlot});
    texel += static_cast<uint32_t>(std::popcount(lanes));
  }
}

void add_nodes(const SliceScene& scene, uint32_t first, uint32_t count, std::span<PacketList> lists) {
  const uint32_t end = first + count;
  for (uint32_t patch = first; patch < end;) {
    const PatchRun run = run_of_patch(scene.patch_set, patch);
    for (uint32_t site = 0; site < kSites; ++site) add_site(scene, run, site, first, end, lists[site]);
    patch = run.first_of(kSlots);
  }
}

}  // namespace hemibake
