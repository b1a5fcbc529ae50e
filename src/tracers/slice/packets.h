// Gathers receivers into packets: neighbouring texels, and the nodes that stand at the same places of them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "surface/facets.h"
#include "tracers/slice/slice_scene.h"
#include "tracers/slice/traversal.h"

namespace hemibake {

inline constexpr uint32_t kNoSlot = kSlots;

// Rows that are wanted of a packet's receivers of one kind.
struct WantedRows {
  uint32_t lanes;  // bits
  uint32_t first;  // texel or patch of the first of them; the next one's is one more
  uint32_t slot;   // of nodes (surface/node_sites.h); kNoSlot: texels
};

// Packets of one family.
struct PacketList {
  std::vector<SlicePacket> packets;
  std::vector<SliceReceivers> receivers;  // all of a packet's, one packet after the other
  std::vector<WantedRows> wanted;         // one per element of receivers

  // Returns `count` packets from `first` on with their receivers. scratch: keeps the packets.
  SlicePackets part(size_t first, size_t count, std::vector<SlicePacket>& scratch) const;
};

// Returns the packet of the texels around one, and its receivers. x: a multiple of kSliceLanes.
SlicePacket texel_packet(const SliceScene& scene, int x, int y);
SliceReceivers texel_receivers(const SliceScene& scene, int x, int y);

// Adds packets of the texels first, first + 1, …
void add_texels(const SliceScene& scene, uint32_t first, uint32_t count, PacketList& list);

// Adds packets of the patches first, first + 1, … of a set of nodes. lists: by site.
void add_nodes(const SliceScene& scene, uint32_t first, uint32_t count, std::span<PacketList> lists);

}  // namespace hemibake
