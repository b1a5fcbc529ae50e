// The bounded model against the published one on the published curves (../shared/reference, skipped where
// absent).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "fitting/models.h"
#include "io/curves_file.h"
#include "model/model.h"

namespace hemibake {
namespace {

// Errors of E/π over the bins below α = 0.9 at one albedo.
struct Errors {
  double rms = 0, max = 0;
};

template <class Model>
Errors measure(const Model& model, const Curves& curves, double albedo) {
  Errors errors;
  int count = 0;
  for (const CurveBin& bin : curves.bins) {
    if (bin_center(bin) >= 0.9) continue;
    const double error = std::abs(model.total(bin_center(bin), albedo) - total_over_pi(bin, albedo));
    errors.rms += error * error;
    errors.max = std::max(errors.max, error);
    ++count;
  }
  errors.rms = std::sqrt(errors.rms / count);
  return errors;
}

TEST(PublishedBoundedModel, IsAtLeastAsAccurateAsThePublishedModelAtEveryAlbedo) {
  const std::filesystem::path path = std::filesystem::path(HEMIBAKE_REFERENCE_DIR) / "published_curves.csv";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  const Curves curves = read_curves(path);
  const std::vector<NamedFit> fits = fit_model("bounded", curves, Abscissa::kCenter, Weights::kNone);
  const BoundedModel bounded{parameter_value(fits[0].fit, "k0"), parameter_value(fits[0].fit, "k1"),
                             parameter_value(fits[1].fit, "q"), parameter_value(fits[1].fit, "d")};
  // Both models are 1 at albedo 1, where rounding decides.
  constexpr double kRounding = 1e-12;
  fmt::print("| albedo | published rms | max | bounded rms | max |\n| --- | --- | --- | --- | --- |\n");
  for (int r = 0; r <= 100; ++r) {
    const double albedo = r / 100.0;
    const Errors published = measure(Mayaux2018Model{}, curves, albedo);
    const Errors ours = measure(bounded, curves, albedo);
    EXPECT_LE(ours.rms, published.rms + kRounding) << "albedo " << albedo;
    EXPECT_LE(ours.max, published.max + kRounding) << "albedo " << albedo;
    if (r % 10 == 0) {
      fmt::print("| {:.1f} | {:.4f} | {:.3f} | {:.4f} | {:.3f} |\n", albedo, published.rms, published.max,
                 ours.rms, ours.max);
    }
  }
}

}  // namespace
}  // namespace hemibake
