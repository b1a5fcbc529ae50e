#include "textures/bounce_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "model/closed_forms.h"
#include "textures/light.h"

namespace hemibake {
namespace {

constexpr int kVisibilityReach = 1, kBounceReach = 3;  // steps from the rounded ones
constexpr size_t kCandidates = size_t{2 * kVisibilityReach + 1} * (2 * kBounceReach + 1);
constexpr double kMeanWeight = 1.5;  // of the mean's error over that of its texels (README.md)
constexpr int kSweeps = 2;           // a third changes nothing in the fifth digit

struct Candidate {
  double squares = 0;  // error of the texel
  StoredPair steps;
};
using Candidates = std::array<Candidate, kCandidates>;

int nearest_step(double value, int steps) {
  return std::isnan(value) ? 0 : static_cast<int>(std::clamp(value, 0.0, 1.0) * steps + 0.5);
}

double squared(double value) { return value * value; }

// Returns the squared errors of a pair at albedo 0 and at kBounceMapAlbedos, summed.
double squared_error(const MappedLight& truth, double visibility, double bounce, double bounce_albedo) {
  double sum = squared(visibility - truth.visibility);
  for (size_t a = 0; a < kBounceMapAlbedos.size(); ++a)
    sum += squared(bounce_map_irradiance(visibility, bounce, kBounceMapAlbedos[a], bounce_albedo) -
                   truth.irradiance[a]);
  return sum;
}

Candidates candidates_of(const MappedLight& light, const StoredPair& rounded, int steps,
                         double bounce_albedo) {
  Candidates candidates;
  size_t count = 0;
  for (int v = -kVisibilityReach; v <= kVisibilityReach; ++v)
    for (int b = -kBounceReach; b <= kBounceReach; ++b) {
      const int visibility = std::clamp(rounded.visibility + v, 0, steps);
      const int bounce = std::clamp(rounded.bounce + b, visibility, steps);
      candidates[count++] = {squared_error(light, static_cast<double>(visibility) / steps,
                                           static_cast<double>(bounce) / steps, bounce_albedo),
                             {visibility, bounce}};
    }
  return candidates;
}

// Chooses one texel's steps. rest: the sum of the other texels'. scale: steps times texels.
StoredPair best_of(const Candidates& candidates, const StoredPair& rest, const MappedLight& mean,
                   double scale, double weight, double bounce_albedo) {
  StoredPair best;
  double least = std::numeric_limits<double>::infinity();
  for (const Candidate& candidate : candidates) {
    if (candidate.squares >= least) continue;
    const double visibility = (rest.visibility + candidate.steps.visibility) / scale;
    const double bounce = (rest.bounce + candidate.steps.bounce) / scale;
    const double squares =
        candidate.squares + weight * squared_error(mean, visibility, bounce, bounce_albedo);
    if (squares >= least) continue;
    least = squares;
    best = candidate.steps;
  }
  return best;
}

}  // namespace

bool knows_mapped_light(const Bake& bake) { return !bake.bounce.empty() && bake.irradiance.size() > 3; }

MappedLight mapped_light_at(const Bake& bake, size_t texel) {
  MappedLight light{visibility_at(bake, texel), bounce_at(bake, texel), {}};
  for (size_t a = 0; a < kBounceMapAlbedos.size(); ++a)
    light.irradiance[a] = irradiance_at(bake, texel, kBounceMapAlbedos[a]);
  return light;
}

LightBlock block_at(int x, int y, int width, int height, const LightOfTexel& light) {
  LightBlock block{std::min(kBounceMapBlock, width - x), std::min(kBounceMapBlock, height - y), {}};
  size_t i = 0;
  for (int row = y; row < y + block.height; ++row)
    for (int column = x; column < x + block.width; ++column)
      block.texels[i++] = light(static_cast<size_t>(row) * static_cast<size_t>(width) + column);
  return block;
}

MappedLight mean_light(const LightBlock& block, const TexelBox& box) {
  MappedLight mean;
  const double share = 1.0 / (box.width * box.height);
  for (int y = box.y; y < box.y + box.height; ++y)
    for (int x = box.x; x < box.x + box.width; ++x) {
      const MappedLight& light =
          block.texels[static_cast<size_t>(y) * static_cast<size_t>(block.width) + static_cast<size_t>(x)];
      mean.visibility += share * light.visibility;
      mean.bounce += share * light.bounce;
      for (size_t a = 0; a < mean.irradiance.size(); ++a) mean.irradiance[a] += share * light.irradiance[a];
    }
  return mean;
}

StoredBlock round_steps(const LightBlock& block, int steps) {
  StoredBlock stored;
  for (size_t i = 0; i < block.size(); ++i)
    stored[i] = {nearest_step(block.texels[i].visibility, steps),
                 nearest_step(block.texels[i].bounce, steps)};
  return stored;
}

StoredBlock choose_steps(const LightBlock& given, int steps, double bounce_albedo) {
  LightBlock block = given;
  for (size_t i = 0; i < block.size(); ++i)
    if (std::isnan(block.texels[i].visibility)) block.texels[i] = {};  // a hole
  StoredBlock chosen = round_steps(block, steps);
  StoredPair sum;
  std::array<Candidates, LightBlock{}.texels.size()> candidates;
  for (size_t i = 0; i < block.size(); ++i) {
    candidates[i] = candidates_of(block.texels[i], chosen[i], steps, bounce_albedo);
    sum = {sum.visibility + chosen[i].visibility, sum.bounce + chosen[i].bounce};
  }
  const MappedLight mean = mean_light(block, {0, 0, block.width, block.height});
  const auto texels = static_cast<double>(block.size());
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (size_t i = 0; i < block.size(); ++i) {
      const StoredPair rest{sum.visibility - chosen[i].visibility, sum.bounce - chosen[i].bounce};
      chosen[i] = best_of(candidates[i], rest, mean, steps * texels, kMeanWeight * texels, bounce_albedo);
      sum = {rest.visibility + chosen[i].visibility, rest.bounce + chosen[i].bounce};
    }
  return chosen;
}

BounceMap choose_bounce_map(int width, int height, int steps, double bounce_albedo,
                            const LightOfTexel& light) {
  BounceMap map{Grid<float>(width, height), Grid<float>(width, height)};
  const auto rows = static_cast<size_t>((height + kBounceMapBlock - 1) / kBounceMapBlock);
  parallel_for(rows, 1, [&](size_t begin, size_t) {
    const int y = static_cast<int>(begin) * kBounceMapBlock;
    for (int x = 0; x < width; x += kBounceMapBlock) {
      const LightBlock block = block_at(x, y, width, height, light);
      const StoredBlock chosen = choose_steps(block, steps, bounce_albedo);
      for (size_t i = 0; i < block.size(); ++i) {
        const int column = static_cast<int>(i) % block.width, row = static_cast<int>(i) / block.width;
        const size_t texel = map.visibility.index(x + column, y + row);
        map.visibility[texel] = static_cast<float>(chosen[i].visibility) / static_cast<float>(steps);
        map.bounce[texel] = static_cast<float>(chosen[i].bounce) / static_cast<float>(steps);
      }
    }
  });
  return map;
}

}  // namespace hemibake
