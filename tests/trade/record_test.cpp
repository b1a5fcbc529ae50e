#include "trade/record.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "io/io_testing.h"

namespace hemibake {
namespace {

// Text, read back and written again, is the same: nothing is lost on the way.
template <class Result>
Result expect_round_trip(const Result& result, Result (*from)(const JsonReader&)) {
  const std::string text = nlohmann::ordered_json(result).dump();
  const auto json = nlohmann::ordered_json::parse(text);
  const Result back = from(JsonReader(json, "r.json"));
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
  const ReferenceFacts back = expect_round_trip(facts, reference_facts_from);
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
  const ScoredRun back = expect_round_trip(run, scored_run_from);
  EXPECT_EQ(back.id(), "cut_rays-256_max-distance-ranges-1.0_directions-uniform");
  EXPECT_EQ(back.settings_text(), run.settings_text());
  EXPECT_EQ(back.cost.memory_bytes, 4096u);
  EXPECT_FALSE(back.error[kAoPlane]);
  EXPECT_EQ(back.error[kDirectPlane]->largest, 0.3);
  EXPECT_EQ(back.curve->at(0).bins, 4);
  EXPECT_FALSE(expect_round_trip(ScoredRun{}, scored_run_from).curve);
}

TEST(Record, WithoutItsValuesIsRefused) {
  const auto empty = nlohmann::ordered_json::object();
  EXPECT_EQ(error_of<InputError>([&] { scored_run_from(JsonReader(empty, "r.json").at("result")); }),
            "r.json: result is not there, expected it");
  EXPECT_EQ(error_of<InputError>([&] {
              scored_run_from({empty, "r.json"});
            }),
            "r.json: method is not there, expected it");
  EXPECT_THROW(reference_facts_from({empty, "r.json"}), InputError);
}

// Every value in turn is gone, or of another type: refused, and never more than that.
template <class Result>
void expect_refusals(const Result& result, Result (*from)(const JsonReader&)) {
  const auto flat = nlohmann::ordered_json(result).flatten();
  for (const auto& [pointer, value] : flat.items())
    for (const nlohmann::ordered_json& other :
         {nlohmann::ordered_json::object(), nlohmann::ordered_json::array(), nlohmann::ordered_json()}) {
      auto json = nlohmann::ordered_json(result);
      json[nlohmann::ordered_json::json_pointer(pointer)] = other;
      try {
        from(JsonReader(json, "r.json"));
      } catch (const InputError&) {
      }
    }
}

TEST(Record, OtherTypesAreRefused) {
  expect_refusals(ScoredRun{}, scored_run_from);
  expect_refusals(ReferenceFacts{}, reference_facts_from);
  auto json = nlohmann::ordered_json(ScoredRun{});
  json["settings"] = {{"rays", 1e300}, {"taps", INT64_MAX}};
  EXPECT_EQ(error_of<InputError>([&] {
              scored_run_from({json, "r.json"});
            }),
            "r.json: settings/taps is 9223372036854775807, expected a whole number from 0 to 2147483647");
}

}  // namespace
}  // namespace hemibake
