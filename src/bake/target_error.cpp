#include "bake/target_error.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/parallel.h"
#include "core/progress.h"
#include "sampling/low_discrepancy.h"
#include "tracers/slice/slice.h"
#include "transport/albedo_light.h"

namespace hemibake {
namespace {

constexpr size_t kPilotBlocks = 96, kCheckBlocks = 96;
constexpr double kLargestShare = 0.25;  // of the map that is sampled
constexpr double kTruncationShare = 0.25;
constexpr double kRoughFactor = 2;  // rays of the rough solution over the fewest
constexpr int kMostBounces = 1000;
constexpr uint64_t kPilotStream = 0x7a0001, kCheckStream = 0x7a0002, kRungStream = 0x7a0003;

struct Block {
  uint32_t first = 0;
  uint32_t count = 0;
};

// Every texel belongs to one block, of a row; a random choice of them, in order.
std::vector<Block> sample_blocks(const Surface& surface, size_t wanted, uint64_t stream, uint64_t seed) {
  std::vector<Block> blocks;
  const uint32_t width = static_cast<uint32_t>(surface.width());
  for (uint32_t y = 0; y < static_cast<uint32_t>(surface.height()); ++y)
    for (uint32_t x = 0; x < width; x += kSampleBlockTexels)
      blocks.push_back({y * width + x, std::min<uint32_t>(kSampleBlockTexels, width - x)});
  const size_t share = static_cast<size_t>(std::ceil(kLargestShare * static_cast<double>(blocks.size())));
  const size_t count = std::min(wanted, share);
  // Fisher-Yates, only as far as needed.
  for (size_t i = 0; i < count; ++i) {
    const size_t left = blocks.size() - i;
    std::swap(blocks[i], blocks[i + mix_bits(seed, stream, i) % left]);
  }
  blocks.resize(count);
  return blocks;
}

// E/π of the patches at each albedo; empty without light.
using PatchLight = std::array<std::vector<double>, kJudgedAlbedos.size()>;

// Values of the sampled texels, block after block.
struct SampleValues {
  std::vector<double> ao, direct;
  std::array<std::vector<double>, kJudgedAlbedos.size()> light;
};

SampleValues trace_sample(const Tracer& tracer, const std::vector<Block>& blocks, const PatchLight& patches) {
  const bool with_light = !patches[0].empty();
  std::vector<uint32_t> begin(blocks.size() + 1, 0);
  for (size_t b = 0; b < blocks.size(); ++b) begin[b + 1] = begin[b] + blocks[b].count;
  SampleValues values;
  values.ao.resize(begin.back());
  values.direct.resize(begin.back());
  if (with_light)
    for (std::vector<double>& light : values.light) light.resize(begin.back());
  parallel_for(blocks.size(), 1, [&](size_t first_block, size_t last_block) {
    for (size_t b = first_block; b < last_block; ++b) {
      std::vector<Row> rows(blocks[b].count);
      TracerCounts counts;
      tracer.trace_texels(blocks[b].first, with_light, rows, counts);
      for (size_t i = 0; i < rows.size(); ++i) {
        const size_t at = begin[b] + i;
        values.ao[at] = rows[i].visible_fraction;
        values.direct[at] = rows[i].direct_over_pi;
        for (size_t a = 0; with_light && a < kJudgedAlbedos.size(); ++a) {
          double reflected = 0;
          for (const FormFactor& link : rows[i].links)
            reflected += static_cast<double>(link.weight) * patches[a][link.patch];
          values.light[a][at] = rows[i].direct_over_pi + kJudgedAlbedos[a] * reflected;
        }
      }
    }
  });
  return values;
}

double rms_between(const std::vector<double>& a, const std::vector<double>& b) {
  double squares = 0;
  for (size_t i = 0; i < a.size(); ++i) squares += (a[i] - b[i]) * (a[i] - b[i]);
  return a.empty() ? 0 : std::sqrt(squares / static_cast<double>(a.size()));
}

TargetErrors errors_between(const SampleValues& a, const SampleValues& b) {
  TargetErrors errors;
  errors.ao = rms_between(a.ao, b.ao);
  errors.direct = rms_between(a.direct, b.direct);
  for (size_t i = 0; i < errors.light.size(); ++i) errors.light[i] = rms_between(a.light[i], b.light[i]);
  return errors;
}

AlbedoLight light_at(const LightTransport& seen, double albedo, std::optional<int> bounces) {
  const std::vector<float> albedos(seen.bounce_matrix().rows, static_cast<float>(albedo));
  AlbedoOptions options;
  options.bounces = bounces;
  return bounce_with_albedo(seen, albedos, options);
}

// Slices err by about 3·10⁻⁴ at 257 azimuths (README, the study); the error wanted is to be many times that.
// Odd: no direction in common with any bake's.
int reference_azimuths(double error) {
  const double factor = std::pow(0.005 / error, 0.7);
  return 2 * static_cast<int>(std::clamp(128 * factor, 64.0, 2048.0)) + 1;
}

std::unique_ptr<Tracer> reference_tracer(const Surface& surface, const TargetOptions& options,
                                         uint64_t stream) {
  SliceOptions slices;
  slices.azimuths = reference_azimuths(options.error);
  slices.patch_kind = options.patch_kind;
  slices.seed = mix_bits(options.seed, stream, 1);
  return make_slice_tracer(surface, slices);
}

// The fewest bounces that leave out at most `allowed` (rms of E/π over texels) at the highest albedo.
int choose_bounces(const LightTransport& rough, double allowed, double& truncation) {
  const double albedo = kJudgedAlbedos.back();
  const std::vector<double> whole = light_at(rough, albedo, std::nullopt).texel_light;
  const auto left_out = [&](int bounces) {
    return rms_between(whole, light_at(rough, albedo, bounces).texel_light);
  };
  int low = 0, high = 1;  // low is too few
  while (high < kMostBounces && left_out(high) > allowed) {
    low = high;
    high = std::min(2 * high, kMostBounces);
  }
  while (high - low > 1) {
    const int middle = low + (high - low) / 2;
    (left_out(middle) > allowed ? low : high) = middle;
  }
  truncation = left_out(high);
  return high;
}

// Rays where the error is `wanted`, on the power law through the last two rungs.
int interpolate_rays(const std::vector<PilotRung>& pilot, double wanted, int most_rays) {
  const PilotRung& last = pilot.back();
  const double after = last.error.worst();
  if (pilot.size() < 2 || after <= 0 || after > wanted) return last.rays;
  const PilotRung& before = pilot[pilot.size() - 2];
  const double slope =
      std::log(after / before.error.worst()) / std::log(static_cast<double>(last.rays) / before.rays);
  if (!(slope < 0)) return last.rays;
  const double rays = last.rays * std::pow(wanted / after, 1 / slope);
  return std::clamp(static_cast<int>(std::ceil(rays)), before.rays + 1, std::min(last.rays, most_rays));
}

}  // namespace

double TargetErrors::worst() const { return std::max({ao, direct, *std::ranges::max_element(light)}); }

TargetChoice choose_for_target(const Surface& surface, const TargetOptions& options) {
  const double cpu_start = process_cpu_seconds();
  TargetChoice choice;
  choice.error = options.error;
  choice.with_light = options.with_light;
  PatchLight patches;
  if (options.with_light) {
    const int rough_rays = static_cast<int>(kRoughFactor * options.fewest_rays);
    const auto tracer = options.make_tracer(rough_rays, mix_bits(options.seed, kPilotStream, 2));
    const LightTransport rough = trace_surface(*tracer, KeptLinks::kAll);
    choice.bounces = choose_bounces(rough, kTruncationShare * options.error, choice.truncation);
    for (size_t a = 0; a < kJudgedAlbedos.size(); ++a)
      patches[a] = light_at(rough, kJudgedAlbedos[a], std::nullopt).patch_light;
  }

  const std::vector<Block> blocks = sample_blocks(surface, kPilotBlocks, kPilotStream, options.seed);
  for (const Block& block : blocks) choice.sampled_texels += block.count;
  choice.reference_azimuths = reference_azimuths(options.error);
  const SampleValues truth = trace_sample(*reference_tracer(surface, options, kPilotStream), blocks, patches);
  // Independent errors add in squares.
  const double wanted =
      std::sqrt(std::max(0.0, options.error * options.error - choice.truncation * choice.truncation));
  for (int rays = options.fewest_rays;; rays = std::min(2 * rays, options.most_rays)) {
    const auto tracer = options.make_tracer(rays, mix_bits(options.seed, kRungStream, choice.pilot.size()));
    choice.pilot.push_back({rays, errors_between(trace_sample(*tracer, blocks, patches), truth)});
    choice.reachable = choice.pilot.back().error.worst() <= wanted;
    if (choice.reachable || rays == options.most_rays) break;
  }
  choice.rays = interpolate_rays(choice.pilot, wanted, options.most_rays);
  choice.pilot_cpu_seconds = process_cpu_seconds() - cpu_start;
  return choice;
}

TargetErrors measure_reached(const Surface& surface, const LightTransport& seen, int bounces,
                             const TargetOptions& options) {
  const std::vector<Block> blocks = sample_blocks(surface, kCheckBlocks, kCheckStream, options.seed);
  PatchLight patches;
  std::array<std::vector<double>, kJudgedAlbedos.size()> texels;
  for (size_t a = 0; options.with_light && a < kJudgedAlbedos.size(); ++a) {
    patches[a] = light_at(seen, kJudgedAlbedos[a], std::nullopt).patch_light;
    texels[a] = light_at(seen, kJudgedAlbedos[a], bounces).texel_light;
  }
  SampleValues baked;
  for (const Block& block : blocks) {
    for (uint32_t texel = block.first; texel < block.first + block.count; ++texel) {
      baked.ao.push_back(static_cast<double>(seen.visible_fraction[texel]));
      baked.direct.push_back(static_cast<double>(seen.direct_over_pi[texel]));
      for (size_t a = 0; options.with_light && a < kJudgedAlbedos.size(); ++a)
        baked.light[a].push_back(texels[a][texel]);
    }
  }
  return errors_between(baked,
                        trace_sample(*reference_tracer(surface, options, kCheckStream), blocks, patches));
}

}  // namespace hemibake
