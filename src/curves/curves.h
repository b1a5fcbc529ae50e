// Sorts texels into bins by their AO and keeps the mean and spread of every bounce in each: irradiance is not
// a function of AO, which a mean without its spread would hide.
#pragma once

#include <span>
#include <vector>

#include "transport/baked_planes.h"

namespace hemibake {

// Holds the irradiance of one bounce over the texels of one bin, 0..π at albedo 1.
struct BounceStatistics {
  double mean = 0;
  double stddev = 0;  // of the texels, not of the mean; divides by the count
};

struct CurveBin {
  double ao_low = 0;  // ao_low <= α < ao_high; the last bin holds α = 1 too
  double ao_high = 0;
  double ao_mean = 0;                     // of the texels in the bin
  double count = 0;                       // texels, a whole number; 0: nothing below is meaningful
  std::vector<BounceStatistics> bounces;  // E_0, E_1, …
};

struct Curves {
  int bounce_count = 0;    // curves in each bin: 1 (E_0 only) and up
  bool has_counts = true;  // false: read from a file with means only; counts are then 1 and deviations 0
  std::vector<CurveBin> bins;
};

// Returns the centre of a bin on the AO axis, 0..1.
double bin_center(const CurveBin& bin);

// Returns E/π of all bounces of one bin at albedo `albedo`, 0..1: Σ ρᵇ E_b/π and the tail after the last
// stored bounce, a geometric series with the ratio of the last two bounces, lowered where the total at albedo
// 1 would exceed π.
double total_over_pi(const CurveBin& bin, double albedo);

// Returns the histogram of a bake: texels of bin min(bins − 1, ⌊bins · α⌋), summed in double in texel order.
// bake: planes `visible_fraction` (0..1) and at least one of `irradiance` (0..), all of the same size.
// bins: 1 and up.
// Throws InputError ("what was wrong, what was expected", no file) on a missing plane or an unusable texel.
Curves make_curves(const Bake& bake, int bins);

// Joins the bins of several sets, to fit one set of constants to all. Bins overlap; a set counts by its bins.
// sets: at least one; bounces that all of them have are kept.
Curves pool_curves(std::span<const Curves> sets);

}  // namespace hemibake
