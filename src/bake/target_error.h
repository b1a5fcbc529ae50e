// Settings from an error wanted: rays and bounces of a bake, found on a sample of the map itself.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "surface/surface.h"
#include "tracers/tracer.h"
#include "transport/trace_surface.h"

namespace hemibake {

// Albedos at which all bounces are summed and compared.
inline constexpr std::array<double, 4> kJudgedAlbedos = {0.2, 0.5, 0.8, 0.95};
// Tracers answer sixteen neighbours together, so a sample is made of blocks of sixteen texels.
inline constexpr int kSampleBlockTexels = 16;

// rms over texels. Light is E/π over all bounces at each of kJudgedAlbedos; all 0 without light.
struct TargetErrors {
  double ao = 0;      // α
  double direct = 0;  // E₀/π
  std::array<double, kJudgedAlbedos.size()> light{};

  double worst() const;
};

struct TargetOptions {
  double error = 0.005;  // wanted of each quantity, above 0
  PatchKind patch_kind = PatchKind::kFacets;
  bool with_light = true;  // false: α and E₀/π only
  int fewest_rays = 4, most_rays = 1 << 16;
  uint64_t seed = 0;  // of the bake: the pilot takes others
  // The bake's tracer with this many rays (or azimuths) and this seed.
  std::function<std::unique_ptr<Tracer>(int rays, uint64_t seed)> make_tracer;
};

struct PilotRung {
  int rays = 0;
  TargetErrors error;
};

struct TargetChoice {
  double error = 0;  // wanted
  bool with_light = true;
  int rays = 0;
  int bounces = 0;
  bool reachable = true;  // false: most_rays are not enough
  uint32_t sampled_texels = 0;
  int reference_azimuths = 0;    // of the slices the sample is compared with
  std::vector<PilotRung> pilot;  // rays doubled until they were enough
  double truncation = 0;         // rms of what later bounces would add to E/π, at the highest albedo
  double pilot_cpu_seconds = 0;
};

// A sample of blocks of texels is traced with more and more rays, and by slices with many azimuths, both with
// light gathered from one rough solution of the whole map. Rays: the power law between the last two rungs, at
// the error wanted less what the bounces leave out. Bounces: the fewest that leave out at most a quarter of
// the error wanted at the highest albedo.
TargetChoice choose_for_target(const Surface& surface, const TargetOptions& options);

// The error of a bake: another sample of its texels against slices with many azimuths. seen: the bake's, with
// links where options.with_light. The patches' own noise is in both and only seen through the texels' sums.
TargetErrors measure_reached(const Surface& surface, const LightTransport& seen, int bounces,
                             const TargetOptions& options);

}  // namespace hemibake
