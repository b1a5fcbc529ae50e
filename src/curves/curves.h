// Sorts texels into bins by an AO, α or V, and keeps the mean and spread of every bounce in each: irradiance
// is not a function of AO, which a mean without its spread would hide.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "transport/baked_planes.h"

namespace hemibake {

// Holds the irradiance of one bounce over the texels of one bin, 0..π at albedo 1.
struct BounceStatistics {
  double mean = 0;
  double stddev = 0;  // of the texels, not of the mean; divides by the count
};

// Selects the AO that sorts the texels.
enum class CurveIndex {
  kAo,          // α, the uniform visible fraction, as in 2018
  kVisibility,  // V = E₀/π, the cosine-weighted one
};

// Returns `ao` or `visibility`, which begin the columns of CURVES.csv.
std::string to_string(CurveIndex index);

struct CurveBin {
  double low = 0;  // low <= index < high, 0..1; the last bin holds 1 too
  double high = 0;
  double mean = 0;                        // index of the texels in the bin
  double count = 0;                       // texels, a whole number; 0: nothing below is meaningful
  std::vector<BounceStatistics> bounces;  // E_0, E_1, …
};

struct Curves {
  CurveIndex index = CurveIndex::kAo;
  int bounce_count = 0;    // curves in each bin: 1 (E_0 only) and up
  bool has_counts = true;  // false: read from a file with means only; counts are then 1 and deviations 0
  std::vector<CurveBin> bins;
};

// Returns the centre of a bin on the axis of its index, 0..1.
double bin_center(const CurveBin& bin);

// Returns V of a bin, the mean E₀/π of its texels, 0..1 or a rounding above.
double bin_visibility(const CurveBin& bin);

// Returns m = (⟨V⟩ − ⟨V²⟩)/(1 − ⟨V⟩), 0..1: by reciprocity the mean chance, weighted by 1 − V, that light
// which leaves the surface goes to the sky. 1 for flat ground, ⟨V⟩ = 1; none for curves without counts.
std::optional<double> mean_escape(const Curves& curves);

// Returns E/π of all bounces of one bin at albedo `albedo`, 0..1: Σ ρᵇ E_b/π and the tail after the last
// stored bounce, a geometric series with the ratio of the last two bounces, lowered where the total at albedo
// 1 would exceed π.
double total_over_pi(const CurveBin& bin, double albedo);

// Returns the histogram of a bake: texels of bin min(bins − 1, ⌊bins · index⌋), summed in double in texel
// order. bake: at least one plane of `irradiance` (0..), and for α `visible_fraction` (0..1), all of the same
// size. V is `visibility`, or irradiance 0 over π where that plane is absent, cut to 0..1. bins: 1 and up.
// Throws InputError ("what was wrong, what was expected", no file) on a missing plane or an unusable texel.
Curves make_curves(const Bake& bake, int bins, CurveIndex index = CurveIndex::kAo);

// Joins the bins of several sets, to fit one set of constants to all. Bins overlap; a set counts by its bins.
// sets: at least one; bounces that all of them have are kept.
// Throws InputError where their indices differ.
Curves pool_curves(std::span<const Curves> sets);

}  // namespace hemibake
