// What a bounce map leaves of the light it stands for: by albedo, by bits of the texture, after box filters.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "textures/bounce_map.h"
#include "transport/baked_planes.h"

namespace hemibake {

// Absolute errors of E/π over the texels.
struct MapError {
  double rms = 0;
  double percentile = 0;  // the 99.9th, too large by up to .001 of its square root
  double largest = 0;
};

struct StoredLoss {
  int bits = 32;  // 32: float; 8: with the steps chosen
  int box = 1;    // texels a side that the stored values and the truth are averaged over
  std::array<MapError, kBounceMapAlbedos.size()> by_albedo;

  double mean_rms() const;  // over the albedos
  double largest() const;
};

struct BounceMapLoss {
  double bounce_albedo = 0;
  // Rms between the plane `bounce` and the stored bounces with a tail that continues the last two. The
  // truth's tail leads to the plane: its own error is smaller at every albedo (README.md).
  double truth_rms = 0;
  std::vector<StoredLoss> stored;  // 32, 16, 8 bits; of each 1, 2 × 2, 4 × 4 texels where such a box fits

  // Returns nothing where the map is smaller than the box.
  const StoredLoss* find(int bits, int box) const;
};

// Returns nothing where the bake has no plane `bounce` or fewer than three bounces.
std::optional<BounceMapLoss> bounce_map_loss(const Bake& bake);

}  // namespace hemibake
