// A bake against the referee: a random sample of texels measured again, quantity by quantity.
//
// What is compared is the difference bake − referee, texel by texel: the spread between texels is in both and
// drops out, so that the interval is that of the disagreement, not of the map. Texels are drawn in strata by
// ambient occlusion (`ao`): each of the equally wide AO bins gets a share in proportion to the root of its
// texel count, so that rare bins are measured too (power allocation: Bankier, "Power Allocations", The
// American Statistician 42, 1988).
//
// Bins are of AO that the referee measures itself. Bins of the bake's own would find errors that no texel
// has: rays that by chance meet more sky raise a texel's α and E₀ and lower its E₁ (a row adds up to 1), so
// that the bake's high bins collect what is too dark in E₁ and its low bins what is too bright.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "surface/surface.h"
#include "transport/baked_planes.h"

namespace hemibake {

struct RefereeCheckOptions {
  size_t texels = 2000;           // sampled, at least 2; all where the map has no more
  int paths = 1024;               // per texel, see RefereeOptions
  double confidence = 0.99;       // of every interval by itself, in (0, 1)
  int bounces = 2;                // E_0 … E_bounces are compared; no more than the bake holds
  double albedo = 0.5;            // of the total over all bounces, 0 … 1 excluded
  double mean_tolerance = 0.005;  // of the means, relative to the referee's
  double bin_tolerance = 0.02;    // of the means in an AO bin, relative to the referee's
  int ao_bins = 10;               // at least 1
  uint64_t seed = 0;
};

// kWithin: |bias| + half_width ≤ tolerance. kOutside: |bias| − half_width > tolerance. kUndecided: neither;
// more paths or texels will tell.
enum class RefereeVerdict { kWithin, kOutside, kUndecided };

// One quantity, over the map or one AO bin. Everything over π.
struct RefereeRow {
  std::string quantity;  // "E0", "E1", …, "total at albedo 0.5", "E0 to E20"
  double ao_low = 0, ao_high = 1;
  size_t texels = 0;        // sampled
  double bake_mean = 0;     // over the sampled texels, weighted to stand for all
  double referee_mean = 0;  // the same texels
  double bias = 0;          // mean of bake − referee
  double half_width = 0;  // of the bias: sampling, referee noise, and what the bake's bounces were cut off at
  double rms_difference =
      0;  // texel by texel, the referee's own noise taken out (0 where the noise is all there is)
  double tolerance = 0;
  RefereeVerdict verdict = RefereeVerdict::kUndecided;
};

struct RefereeCheck {
  std::vector<RefereeRow> means;  // over the map: E_0 … E_bounces, total at `albedo`, and the bake's own sum
                                  // of bounces at albedo 1
  std::vector<RefereeRow> bins;  // the same quantities per AO bin that holds two texels or more, bin by bin
  size_t texels = 0;
  uint64_t paths_per_texel = 0;
  uint64_t rays = 0;
  uint64_t truncated_rays = 0;  // see RefereeEstimates
};

// surface: what was baked, with the normals the bake used. The bake needs `visible_fraction` and at least one
// plane of `irradiance`. Throws InputError where options or planes do not fit.
RefereeCheck check_against_referee(const Surface& surface, const Bake& bake,
                                   const RefereeCheckOptions& options);

// kOutside where any row is, else kUndecided where any is.
RefereeVerdict worst_verdict(const std::vector<RefereeRow>& rows);

// Returns whether no row is outside its tolerance.
bool has_passed(const RefereeCheck& check);

}  // namespace hemibake
