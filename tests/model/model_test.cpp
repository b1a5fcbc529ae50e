#include "model/model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace hemibake {
namespace {

// The corners of the parameter box and constants as fits give them.
const BoundedModel kBoundedModels[] = {
    {0.5, 0.9, 1, 0.77},   {0.07, 1, 0.51, 0.83}, {-0.02, 1, 0.36, 0.8}, {-1, -1, 1, 0},    {1, 1, 1, 0.999},
    {-1, 1, 0.001, 0.999}, {1, -1, 0.001, 0},     {0, 0, 0.5, 0.5},      {1, -1, 1, 0.999},
};

TEST(BoundedModel, CornerValues) {
  for (const BoundedModel& model : kBoundedModels) {
    EXPECT_EQ(model.direct(0.0), 0);
    EXPECT_EQ(model.direct(1.0), 1);
    EXPECT_EQ(model.blocked(0.0), 1);
    EXPECT_EQ(model.blocked(1.0), 0);
    EXPECT_NEAR(model.escape(0.0), model.q * (1 - model.d), 1e-15);
    EXPECT_EQ(model.escape(1.0), model.q);
    EXPECT_EQ(model.total(1.0, 0.5), 1);
    EXPECT_EQ(model.total(0.3, 0.0), model.direct(0.3));
    EXPECT_EQ(model.total(0.0, 0.0), 0);
    EXPECT_NEAR(model.total(0.0, 1.0), 1, 1e-15);
    EXPECT_NEAR(model.total(0.3, 1.0), 1, 1e-15);
  }
}

TEST(BoundedModel, SphericalPitIsExact) {
  // In a spherical cap that sees C of the sky every bounce is (1 − C) of the one before. With q
  // = C and d = 0 the model is that series.
  const double c = 0.75;
  const BoundedModel model{0, 0, c, 0};  // F₀ = α: at α = C
  for (const double albedo : {0.1, 0.5, 0.9, 1.0}) {
    EXPECT_NEAR(model.total(c, albedo), c / (1 - albedo * (1 - c)), 1e-15);
  }
  EXPECT_NEAR(model.first_bounce(c), c * (1 - c), 1e-15);
}

TEST(BoundedModel, TotalIsTheSumOfItsBounces) {
  for (const BoundedModel& model : kBoundedModels) {
    for (double ao = 0.05; ao < 1; ao += 0.1) {
      const double albedo = 0.8;
      double sum = model.direct(ao), bounce = albedo * model.first_bounce(ao);
      for (int b = 1; b < 400; ++b, bounce *= albedo * model.bounce_ratio(ao)) sum += bounce;
      EXPECT_NEAR(model.total(ao, albedo), sum, 1e-12);
    }
  }
}

TEST(BoundedModel, LiesBetweenTheTheoreticalBoundsAndRises) {
  for (const BoundedModel& model : kBoundedModels) {
    for (int i = 0; i <= 1000; ++i) {
      const double ao = i / 1000.0, next = std::min(1.0, ao + 1e-3);
      EXPECT_GE(model.direct(ao), ao * ao - 1e-15);
      EXPECT_LE(model.direct(ao), ao * (2 - ao) + 1e-15);
      EXPECT_GE(model.direct(next), model.direct(ao));
      EXPECT_GE(model.bounce_ratio(ao), 0);
      EXPECT_LT(model.bounce_ratio(ao), 1);
      EXPECT_NEAR(model.direct(ao) + model.blocked(ao), 1, 1e-15);
      for (const double albedo : {0.0, 0.3, 0.7, 0.95, 1.0}) {
        EXPECT_GE(model.total(next, albedo), model.total(ao, albedo) - 1e-15) << ao << " " << albedo;
        EXPECT_GE(model.total(ao, std::min(1.0, albedo + 0.01)), model.total(ao, albedo) - 1e-15);
      }
    }
  }
}

// Every float value finite and in 0..1 on a grid of 10⁴ × 10³. One model here; the corners of the box on 10³
// × 10².
template <class Model>
void expect_unit_range(const Model& model, int ao_steps, int albedo_steps) {
  float lowest = 2, highest = -1;
  int not_finite = 0;
  const auto look_at = [&](float value) {
    not_finite += !std::isfinite(value);
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
  };
  for (int i = 0; i <= ao_steps; ++i) {
    const float ao = static_cast<float>(i) / static_cast<float>(ao_steps);
    look_at(model.direct(ao));
    look_at(model.first_bounce(ao));
    look_at(model.bounce_ratio(ao));
    for (int r = 0; r <= albedo_steps; ++r) {
      look_at(model.total(ao, static_cast<float>(r) / static_cast<float>(albedo_steps)));
    }
  }
  EXPECT_EQ(not_finite, 0);
  EXPECT_GE(lowest, 0);
  EXPECT_LE(highest, 1);
}

TEST(BoundedModel, EveryFloatIsFiniteAndInUnitRange) {
  expect_unit_range(kBoundedModels[0], 10000, 1000);
  for (const BoundedModel& model : kBoundedModels) expect_unit_range(model, 1000, 100);
}

TEST(GuardedModel, EveryFloatIsFiniteAndInUnitRange) { expect_unit_range(GuardedModel{}, 10000, 1000); }

// τ of the published constants is in 0..1 up to here.
constexpr double kLastSound = 0.763267;

TEST(GuardedModel, IsThePublishedModelWhereThatOneIsSound) {
  const GuardedModel guarded;
  for (double ao = 0.01; ao < 0.76; ao += 0.01) {
    for (const double albedo : {0.1, 0.5, 0.9, 1.0}) {
      EXPECT_NEAR(guarded.total(ao, albedo), guarded.formulas.total(ao, albedo), 1e-14);
    }
    EXPECT_NEAR(guarded.bounce_ratio(ao), guarded.formulas.bounce_ratio(ao), 1e-14);
  }
}

TEST(Mayaux2018Model, ExceedsOneFrom0949253) {
  const Mayaux2018Model model;
  double highest = 0;
  for (int i = 0; i <= 100000; ++i) highest = std::max(highest, model.direct(i / 100000.0));
  EXPECT_NEAR(highest, 1.00614, 1e-5);
}

TEST(Mayaux2018Model, RatioOfBouncesLeavesItsRangeFrom0763) {
  const Mayaux2018Model model;
  EXPECT_GT(model.bounce_ratio(kLastSound), 0);
  EXPECT_LT(model.bounce_ratio(kLastSound + 0.001), 0);
  EXPECT_LT(model.bounce_ratio(0.94905), -100);
  EXPECT_GT(model.bounce_ratio(0.96), 2);  // on the other side of the pole at 0.949253
}

// Above 0.949254 both F₁ and 1 − F₀ are continuous and 1 − F₀ is not 0: where 1 − ρτ changes sign there, the
// total has a pole. At ρ = 1 it is exactly 1.
TEST(Mayaux2018Model, TotalHasAPoleAtEveryAlbedoBelowOne) {
  const Mayaux2018Model model;
  for (const double albedo : {0.1, 0.3, 0.5, 0.8, 0.9, 0.99}) {
    int sign_changes = 0;
    for (double ao = 0.9493; ao < 0.9999; ao += 1e-5) {
      sign_changes +=
          (1 - albedo * model.bounce_ratio(ao) > 0) != (1 - albedo * model.bounce_ratio(ao + 1e-5) > 0);
    }
    EXPECT_GE(sign_changes, 1) << "albedo " << albedo;
  }
  EXPECT_NEAR(model.total(0.9, 1.0), 1, 1e-12);
}

TEST(JimenezModel, CornerValues) {
  const JimenezModel model;
  EXPECT_EQ(model.total(0.0, 0.5), 0);
  EXPECT_NEAR(model.total(1.0, 1.0), 1, 1e-3);  // their constants add up to 1.0001
  EXPECT_GE(model.total(0.5, 0.0), 0.5);        // never below the visibility itself
}

}  // namespace
}  // namespace hemibake
