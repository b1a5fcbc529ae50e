#include "transport/solver/block_jacobi.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parallel.h"
#include "support/maps.h"
#include "support/threads.h"
#include "tracers/slice/slice.h"
#include "transport/trace_surface.h"

namespace hemibake {
namespace {

using Rows = std::vector<std::vector<FormFactor>>;

FormFactorMatrix links_of(const Rows& rows) {
  FormFactorMatrix form_factors =
      make_form_factors(static_cast<uint32_t>(rows.size()), static_cast<uint32_t>(rows.size()));
  for (size_t i = 0; i < rows.size(); ++i)
    append_row(form_factors.blocks[i / FormFactorMatrix::kRowsPerBlock], rows[i]);
  finish_blocks(form_factors);
  return form_factors;
}

TEST(BlockJacobi, APairIsAGeometricSeries) {
  // 0.75 and 0.5 stay what they are in links: quarters. Patch 1 sees 0 and 2 by little.
  const BlockJacobi groups =
      make_block_jacobi(links_of({{{2, 0.75f}}, {{0, 0.125f}, {2, 0.125f}}, {{0, 0.5f}}, {}}), {});
  EXPECT_EQ(groups.members, (std::vector<uint32_t>{0, 2}));
  EXPECT_EQ(groups.first_member, (std::vector<uint32_t>{0, 2}));
  // (1 −¾; −½ 1)⁻¹ = (1 ¾; ½ 1) / (1 − ⅜)
  std::vector<double> light{1, 7, 10, 3};
  apply_block_jacobi(groups, light);
  const double series = 1 / (1 - 0.375);
  const std::vector<double> expected{series * (1 + 7.5), 7, series * (0.5 + 10), 3};
  for (size_t i = 0; i < light.size(); ++i)
    EXPECT_NEAR(light[i], expected[i], 1e-6 * expected[i]);  // entries are floats
}

TEST(BlockJacobi, AlbedoWeakensLinks) {
  const FormFactorMatrix form_factors = links_of({{{1, 1.0f}}, {{0, 0.75f}}});
  const std::vector<float> weak{0.25f, 0.25f}, uneven{0.5f, 1.0f};
  EXPECT_EQ(make_block_jacobi(form_factors, weak).count(), 0u);
  const BlockJacobi groups = make_block_jacobi(form_factors, uneven);
  ASSERT_EQ(groups.count(), 1u);
  // (1 −1·1; −0.75·0.5 1)⁻¹
  EXPECT_NEAR(groups.inverse[1], 1 / (1 - 0.375), 1e-6);
  EXPECT_NEAR(groups.inverse[2], 0.375 / (1 - 0.375), 1e-6);
}

TEST(BlockJacobi, WhatLosesNothingIsLeftAlone) {
  const BlockJacobi groups = make_block_jacobi(links_of({{{1, 1.0f}}, {{0, 1.0f}}}), {});
  std::vector<double> light{0.25, 0.5};
  apply_block_jacobi(groups, light);
  EXPECT_EQ(light, (std::vector<double>{0.25, 0.5}));
  // A row that sees only itself has no other to be with.
  EXPECT_EQ(make_block_jacobi(links_of({{{0, 1.0f}}, {{0, 0.125f}}}), {}).count(), 0u);
}

TEST(BlockJacobi, GroupsAndEntriesAreBounded) {
  // A ring of strong links: it would be one group.
  constexpr uint32_t kPatches = 1000;
  Rows rows(kPatches);
  for (uint32_t i = 0; i < kPatches; ++i) rows[i] = {{(i + 1) % kPatches, 0.75f}};
  const BlockJacobi groups = make_block_jacobi(links_of(rows), {});
  EXPECT_GT(groups.count(), 0u);
  EXPECT_LE(groups.inverse.size(), 2u * kPatches);
  for (size_t g = 0; g < groups.count(); ++g)
    EXPECT_LE(groups.first_member[g + 1] - groups.first_member[g], BlockJacobi::kMostMembers);
}

TEST(BlockJacobi, SameBytesAtAnyThreadCount) {
  const Surface surface = white_noise_surface(24, 24, 0.5);
  SliceOptions options;
  options.azimuths = 8;
  const LightTransport transport = trace_surface(*make_slice_tracer(surface, options), KeptLinks::kAll);
  set_thread_count(1);
  const BlockJacobi one = make_block_jacobi(transport.patch_form_factors, {});
  set_thread_count(2);
  const BlockJacobi two = make_block_jacobi(transport.patch_form_factors, {});
  set_thread_count(0);
  EXPECT_GT(one.count(), 0u);
  EXPECT_EQ(one.members, two.members);
  EXPECT_EQ(one.inverse, two.inverse);
}

}  // namespace
}  // namespace hemibake
