// The constants in fits/: read back, held against new fits of the same data, within their own standard
// errors.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "fitting/models.h"
#include "io/curves_file.h"
#include "io/fit_file.h"
#include "io/io_testing.h"
#include "model/model.h"
#include "support/run_command.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

FitFile stored(const std::string& name) {
  return read_fits(fs::path(HEMIBAKE_SOURCE_DIR) / "fits" / (name + ".json"));
}

const Fit& fit_called(const FitFile& file, const std::string& name) {
  for (const NamedFit& named : file.fits) {
    if (named.name == name) return named.fit;
  }
  throw std::runtime_error("no fit " + name);
}

// Every parameter of `expected` is found again to `errors` of its standard errors; one on a bound to `slack`.
void expect_same(const FitFile& expected, const FitFile& found, double errors, double slack) {
  for (const auto& [name, fit] : expected.fits) {
    for (const FitParameter& parameter : fit.parameters) {
      const double value = parameter_value(fit_called(found, name), parameter.name);
      const double tolerance = parameter.standard_error ? errors * *parameter.standard_error : slack;
      EXPECT_NEAR(value, parameter.value, tolerance) << name << " " << parameter.name;
    }
  }
}

TEST(StoredFits, AllCanBeReadAndSayWhereTheyComeFrom) {
  int count = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(HEMIBAKE_SOURCE_DIR) / "fits")) {
    if (entry.path().extension() != ".json") continue;
    const FitFile file = read_fits(entry.path());
    EXPECT_FALSE(file.fits.empty()) << entry.path();
    EXPECT_TRUE(file.provenance.contains("input") && file.provenance.contains("input_sha256"))
        << entry.path();
    for (const auto& [name, fit] : file.fits) {
      EXPECT_EQ(fit.covariance.size(), fit.parameters.size() * fit.parameters.size())
          << entry.path() << " " << name;
    }
    ++count;
  }
  EXPECT_GE(count, 8);
}

TEST(StoredFits, PublishedConstantsAreThoseOfTheModel) {
  const FitFile file = stored("published");
  const Mayaux2018Model model;
  EXPECT_EQ(parameter_value(fit_called(file, "F0"), "k"), model.k);
  EXPECT_EQ(parameter_value(fit_called(file, "F0"), "e"), model.e);
  EXPECT_EQ(parameter_value(fit_called(file, "F1"), "A"), model.a);
  EXPECT_EQ(parameter_value(fit_called(file, "F1"), "B"), model.b);
}

FitFile refit(const Curves& curves, const std::vector<std::string>& models, Abscissa abscissa) {
  FitFile file;
  for (const std::string& model : models) {
    for (NamedFit& named : fit_model(model, curves, abscissa, Weights::kNone))
      file.fits.push_back(std::move(named));
  }
  return file;
}

// The same data give the same minimum: a thousandth of a standard error is the room for other compilers and
// libraries.
constexpr double kSameMinimum = 1e-3;

TEST(StoredFits, PublishedCurvesGiveTheStoredConstants) {
  const fs::path path = fs::path(HEMIBAKE_REFERENCE_DIR) / "published_curves.csv";
  if (!fs::exists(path)) GTEST_SKIP() << path << " is not there";
  const Curves curves = read_curves(path);
  expect_same(stored("published_refit"), refit(curves, {"published"}, Abscissa::kMayaux2018), kSameMinimum,
              0);
  expect_same(stored("published_centers"),
              refit(curves, default_fit_models(CurveIndex::kAo), Abscissa::kCenter), kSameMinimum, 0);
  expect_same(stored("published_bounces"), refit(curves, {"bounces", "jimenez"}, Abscissa::kCenter),
              kSameMinimum, 0);
  EXPECT_EQ(stored("published_centers").provenance["input_sha256"], sha256_of_file(path));
}

// How far the published constants are from the curves they stand for, as stored beside them.
TEST(StoredFits, PublishedConstantsHaveTheErrorsStored) {
  const fs::path path = fs::path(HEMIBAKE_REFERENCE_DIR) / "published_curves.csv";
  if (!fs::exists(path)) GTEST_SKIP() << path << " is not there";
  const Curves curves = read_curves(path);
  const Mayaux2018Model model;
  double direct = 0, first = 0;
  for (const CurvePoint& point : curve_points(curves, 0, Abscissa::kCenter, Weights::kNone)) {
    direct += std::pow(model.direct(point.ao) - point.value, 2);
  }
  for (const CurvePoint& point : curve_points(curves, 1, Abscissa::kCenter, Weights::kNone)) {
    first += std::pow(model.first_bounce(point.ao) - point.value, 2);
  }
  EXPECT_NEAR(std::sqrt(direct / 100), fit_called(stored("published"), "F0").rms, 1e-8);
  EXPECT_NEAR(std::sqrt(first / 100), fit_called(stored("published"), "F1").rms, 1e-8);
}

TEST(StoredFits, CurvesOfOurMapsGiveTheStoredConstants) {
  std::vector<Curves> sets;
  for (const std::string name : {"bricks", "shapes", "concrete", "noise"}) {
    sets.push_back(read_curves(fs::path(HEMIBAKE_SOURCE_DIR) / "fits" / "curves" / (name + ".csv")));
    expect_same(stored(name), refit(sets.back(), default_fit_models(CurveIndex::kAo), Abscissa::kCenter),
                kSameMinimum, 0);
  }
  expect_same(stored("all_maps"),
              refit(pool_curves(sets), default_fit_models(CurveIndex::kAo), Abscissa::kCenter), kSameMinimum,
              0);
}

// From the map to the constants with an eighth of the rays: every constant within two of its standard errors.
TEST(StoredFits, BakingTheBricksAgainGivesTheStoredConstants) {
  const TemporaryFolder folder;
  const CommandOutcome outcome = run_hemibake(fmt::format("run '{}/heightmaps/bricks.png' -o '{}' --rays 64",
                                                          HEMIBAKE_SOURCE_DIR, (folder / "run").string()),
                                              folder.path());
  ASSERT_TRUE(fs::exists(folder / "run" / "fit.json")) << outcome.err;
  expect_same(stored("bricks"), read_fits(folder / "run" / "fit.json"), 2, 0.05);
}

}  // namespace
}  // namespace hemibake
