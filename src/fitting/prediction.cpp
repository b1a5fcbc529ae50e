#include "fitting/prediction.h"

#include <algorithm>
#include <cmath>

namespace hemibake {
namespace {

constexpr int kAlbedoSteps = 10;

}  // namespace

Score score_prediction(const Prediction& prediction, const Curves& curves) {
  Score score;
  double sum = 0;
  int count = 0;
  for (const CurveBin& bin : curves.bins) {
    if (bin.count == 0) continue;
    for (int r = 0; r <= kAlbedoSteps; ++r) {
      const double albedo = static_cast<double>(r) / kAlbedoSteps;
      const double error =
          prediction(bin_center(bin), bin_visibility(bin), albedo) - total_over_pi(bin, albedo);
      sum += error * error;
      score.max_error = std::max(score.max_error, std::abs(error));
      ++count;
    }
  }
  score.rms = count == 0 ? 0 : std::sqrt(sum / count);
  return score;
}

}  // namespace hemibake
