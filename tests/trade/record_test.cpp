#include "trade/record.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace hemibake {
namespace {

// Text, read back and written again, is the same: nothing is lost on the way.
template <class Result>
Result expect_round_trip(const Result& result) {
  const std::string text = nlohmann::ordered_json(result).dump();
  const auto back = nlohmann::ordered_json::parse(text).get<Result>();
  EXPECT_EQ(nlohmann::ordered_json(back).dump(), text);
  return back;
}

TEST(Record, ReferenceIsReadBack) {
  ReferenceFacts facts;
  facts.width = 3;
  facts.can_halve = true;
  facts.height_range_m = 0.1;
  facts.mean[kFirstPlane] = 1.0 / 3;
  facts.error[kAoPlane] = 1e-5;
  facts.best_run_error.back() = 2;
  facts.referee = {{.quantity = "E0", .texels = 7, .bake_mean = 0.25}};
  facts.models.eq12 = Mayaux2018Model{0.4, 1.2, 20, 3.2};
  facts.models_on_true_ao = {{"plain", {}}};
  facts.models_on_true_ao[0].error[1].p99 = 0.125;
  const ReferenceFacts back = expect_round_trip(facts);
  EXPECT_EQ(back.mean[kFirstPlane], 1.0 / 3);
  EXPECT_EQ(back.referee.at(0).texels, 7u);
  ASSERT_TRUE(back.models.eq12);
  EXPECT_EQ(back.models.eq12->b, 3.2);
  EXPECT_FALSE(back.models.bounded);
  EXPECT_EQ(back.models_on_true_ao.at(0).error[1].p99, 0.125);
}

TEST(Record, RunIsReadBack) {
  ScoredRun run;
  run.method = "cut";
  run.add_setting("rays", 256);
  run.add_setting("max-distance-ranges", 1.0);
  run.add_setting("directions", "uniform");
  run.representative = true;
  run.cost = {0.5, 0.25, 3, 4096};
  run.work = 99;
  run.known = 0.75;
  run.error[kDirectPlane] = ErrorStatistics{0.1, -0.1, 0.3, 0.2};
  run.curve = CurveErrors{CurveError{1, 2, 3, 4}, {}};
  run.models = {{"bounded", {}}};
  const ScoredRun back = expect_round_trip(run);
  EXPECT_EQ(back.id(), "cut_rays-256_max-distance-ranges-1.0_directions-uniform");
  EXPECT_EQ(back.settings_text(), run.settings_text());
  EXPECT_EQ(back.cost.memory_bytes, 4096u);
  EXPECT_FALSE(back.error[kAoPlane]);
  EXPECT_EQ(back.error[kDirectPlane]->largest, 0.3);
  EXPECT_EQ(back.curve->at(0).bins, 4);
  EXPECT_FALSE(expect_round_trip(ScoredRun{}).curve);
}

TEST(Record, WithoutItsValuesIsRefused) {
  EXPECT_THROW(nlohmann::ordered_json::object().get<ScoredRun>(), nlohmann::ordered_json::exception);
  EXPECT_THROW(nlohmann::ordered_json::object().get<ReferenceFacts>(), nlohmann::ordered_json::exception);
}

}  // namespace
}  // namespace hemibake
