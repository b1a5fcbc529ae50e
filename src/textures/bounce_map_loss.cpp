#include "textures/bounce_map_loss.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/parallel.h"
#include "model/closed_forms.h"
#include "textures/light.h"

namespace hemibake {
namespace {

constexpr std::array kBits = {32, 16, 8}, kBoxes = {1, 2, 4};
constexpr size_t kAlbedos = kBounceMapAlbedos.size(), kStored = kBits.size() * kBoxes.size();
constexpr size_t kPieces = 32;  // of the map, summed in their order
constexpr double kPercentile = 0.999;

// Counts errors by their square root: bins are narrow where errors are small.
class Histogram {
 public:
  void add(double error) { ++counts_[std::min(kBins - 1, static_cast<size_t>(std::sqrt(error) * kBins))]; }
  void add(const Histogram& other) {
    for (size_t i = 0; i < kBins; ++i) counts_[i] += other.counts_[i];
  }

  // Returns the upper end of the bin that holds the percentile.
  double percentile(size_t count) const {
    const auto rank = static_cast<size_t>(std::ceil(kPercentile * static_cast<double>(count)));
    size_t below = 0, i = 0;
    while (i < kBins && (below += counts_[i]) < rank) ++i;
    const double end = static_cast<double>(i + 1) / kBins;
    return end * end;
  }

 private:
  static constexpr size_t kBins = 2048;
  std::array<uint32_t, kBins> counts_{};
};

struct ErrorSum {
  size_t count = 0;
  double squares = 0, largest = 0;
  Histogram histogram;

  void add(double error) {
    ++count;
    squares += error * error;
    largest = std::max(largest, error);
    histogram.add(error);
  }
  void add(const ErrorSum& other) {
    count += other.count;
    squares += other.squares;
    largest = std::max(largest, other.largest);
    histogram.add(other.histogram);
  }
  MapError error() const {
    return {std::sqrt(squares / static_cast<double>(count)), std::min(histogram.percentile(count), largest),
            largest};
  }
};

// Sums over a piece of the map, in the order of BounceMapLoss::stored.
struct PieceSums {
  std::array<std::array<ErrorSum, kAlbedos>, kStored> errors;
  double truth_squares = 0;

  void add(const PieceSums& other) {
    truth_squares += other.truth_squares;
    for (size_t s = 0; s < kStored; ++s)
      for (size_t a = 0; a < kAlbedos; ++a) errors[s][a].add(other.errors[s][a]);
  }
};

// Returns the block with visibility and bounce as a texture of some bits gives them back.
LightBlock as_stored(const LightBlock& block, int bits, double bounce_albedo) {
  if (bits == 32) return block;
  const int steps = (1 << bits) - 1;
  const StoredBlock stored =
      bits == 8 ? choose_steps(block, steps, bounce_albedo) : round_steps(block, steps);
  LightBlock result = block;
  for (size_t i = 0; i < block.size(); ++i) {
    result.texels[i].visibility = static_cast<double>(stored[i].visibility) / steps;
    result.texels[i].bounce = static_cast<double>(stored[i].bounce) / steps;
  }
  return result;
}

void add_block(const LightBlock& block, double bounce_albedo, PieceSums& sums) {
  size_t s = 0;
  for (const int bits : kBits) {
    const LightBlock stored = as_stored(block, bits, bounce_albedo);
    for (const int box : kBoxes) {
      std::array<ErrorSum, kAlbedos>& errors = sums.errors[s++];
      for (int y = 0; y + box <= block.height; y += box)
        for (int x = 0; x + box <= block.width; x += box) {
          const MappedLight light = mean_light(stored, {x, y, box, box});
          if (std::isnan(light.irradiance[0])) continue;  // a hole is in it
          for (size_t a = 0; a < kAlbedos; ++a)
            errors[a].add(std::abs(
                bounce_map_irradiance(light.visibility, light.bounce, kBounceMapAlbedos[a], bounce_albedo) -
                light.irradiance[a]));
        }
    }
  }
}

void sum_rows(const Bake& bake, int first_row, int end_row, PieceSums& sums) {
  const LightOfTexel light = [&](size_t texel) {
    const double off = irradiance_by_bounces(bake, texel, bake.bounce_albedo) - bounce_at(bake, texel);
    if (!is_hole(bake, texel)) sums.truth_squares += off * off;
    return mapped_light_at(bake, texel);
  };
  for (int y = first_row; y < end_row; y += kBounceMapBlock)
    for (int x = 0; x < bake.width; x += kBounceMapBlock)
      add_block(block_at(x, y, bake.width, bake.height, light), bake.bounce_albedo, sums);
}

BounceMapLoss loss_of(const Bake& bake, const PieceSums& sums) {
  BounceMapLoss loss;
  loss.bounce_albedo = bake.bounce_albedo;
  loss.truth_rms = std::sqrt(sums.truth_squares / static_cast<double>(sums.errors[0][0].count));
  size_t s = 0;
  for (const int bits : kBits)
    for (const int box : kBoxes) {
      const std::array<ErrorSum, kAlbedos>& errors = sums.errors[s++];
      if (errors[0].count == 0) continue;
      StoredLoss& stored = loss.stored.emplace_back(StoredLoss{bits, box, {}});
      std::ranges::transform(errors, stored.by_albedo.begin(), &ErrorSum::error);
    }
  return loss;
}

}  // namespace

double StoredLoss::mean_rms() const {
  double sum = 0;
  for (const MapError& error : by_albedo) sum += error.rms;
  return sum / static_cast<double>(by_albedo.size());
}

double StoredLoss::largest() const { return std::ranges::max(by_albedo, {}, &MapError::largest).largest; }

const StoredLoss* BounceMapLoss::find(int bits, int box) const {
  const auto found = std::ranges::find_if(
      stored, [&](const StoredLoss& loss) { return loss.bits == bits && loss.box == box; });
  return found == stored.end() ? nullptr : &*found;
}

std::optional<BounceMapLoss> bounce_map_loss(const Bake& bake) {
  if (!knows_mapped_light(bake)) return std::nullopt;
  const int blocks = (bake.height + kBounceMapBlock - 1) / kBounceMapBlock;
  const auto grain = static_cast<size_t>(blocks + int{kPieces} - 1) / kPieces;
  std::vector<PieceSums> pieces((static_cast<size_t>(blocks) + grain - 1) / grain);
  parallel_for(static_cast<size_t>(blocks), grain, [&](size_t begin, size_t end) {
    sum_rows(bake, static_cast<int>(begin) * kBounceMapBlock,
             std::min(bake.height, static_cast<int>(end) * kBounceMapBlock), pieces[begin / grain]);
  });
  for (size_t i = 1; i < pieces.size(); ++i) pieces[0].add(pieces[i]);
  return loss_of(bake, pieces[0]);
}

}  // namespace hemibake
