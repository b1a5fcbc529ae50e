// Compares a bake with the reference path tracer: a random sample of texels measured again, quantity by
// quantity.
//
// Estimates the difference bake − reference texel by texel: the spread between texels is in both and drops
// out, so that the interval is that of the disagreement, not of the map. Texels are drawn in strata by
// ambient occlusion: each of the equally wide AO bins gets a share in proportion to the root of its texel
// count, so that rare bins are measured too (power allocation: Bankier, "Power Allocations", The American
// Statistician 42, 1988).
//
// Bins are of AO that the path tracer measures itself. Bins of the bake's own AO would find errors that no
// texel has: rays that by chance meet more sky raise a texel's α and E₀ and lower its E₁ (a row adds up to
// 1), so that high bins collect texels too dark in E₁ and low bins texels too bright.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/grid.h"
#include "surface/surface.h"

namespace hemibake {

// The light of a bake to be judged: planes of the map's size that must outlive their use.
struct JudgedLight {
  const Grid<float>& ao;                    // α, 0..1
  std::span<const Grid<float>> irradiance;  // E_0, E_1, … at albedo 1, 0..π
};

struct RefereeCheckOptions {
  size_t texels = 2000;           // sampled, at least 2; all where the map has no more
  int paths = 1024;               // per texel, see RefereeOptions
  double confidence = 0.99;       // of every interval by itself, in (0, 1)
  int bounces = 2;                // E_0 … E_bounces are compared; no more than the bake holds
  double albedo = 0.5;            // of the total over all bounces, 0 … 1 excluded
  double mean_tolerance = 0.005;  // of the means, relative to the reference's
  double bin_tolerance = 0.02;    // of the means in an AO bin, relative to the reference's
  int ao_bins = 10;               // at least 1
  uint64_t seed = 0;
};

// kWithin: |bias| + half_width ≤ tolerance. kOutside: |bias| − half_width > tolerance. kUndecided: neither,
// which more paths or texels decide.
enum class RefereeVerdict { kWithin, kOutside, kUndecided };

// The comparison of one quantity over the map or one AO bin. Everything over π.
struct RefereeRow {
  std::string quantity;  // "E0", "E1", …, "total at albedo 0.5", "E0 to E20"
  double ao_low = 0, ao_high = 1;
  size_t texels = 0;          // sampled
  double bake_mean = 0;       // over the sampled texels, weighted to stand for all
  double referee_mean = 0;    // of the same texels
  double bias = 0;            // mean of bake − reference
  double half_width = 0;      // of the bias: sampling, noise of the reference, bounces the bake does not hold
  double rms_difference = 0;  // over texels, the noise of the reference taken out; 0 if there is only noise
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

// Measures a sample of texels by path tracing and compares them with the bake.
// surface: that was baked, with the normals the bake used.
// bake: with AO and at least one plane of irradiance. Throws InputError for options or planes that do not
// fit.
RefereeCheck check_against_referee(const Surface& surface, const JudgedLight& bake,
                                   const RefereeCheckOptions& options);

// Returns kOutside if any row is, else kUndecided if any is, else kWithin.
RefereeVerdict worst_verdict(const std::vector<RefereeRow>& rows);

// Returns whether no row is outside its tolerance.
bool has_passed(const RefereeCheck& check);

}  // namespace hemibake
