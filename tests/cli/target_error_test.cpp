// `bake --target-error` through the real binary: it states its choice and the error reached, and refuses
// contradictions.
#include "cli/run_hemibake.h"

namespace hemibake {
namespace {

using testing::HasSubstr;

class TargetErrorOption : public CliTest {
 protected:
  void SetUp() override { write_map("map.exr", SyntheticKind::kBricks, 32, 32); }
};

TEST_F(TargetErrorOption, ChoosesAndStatesWhatItReached) {
  const auto json = run_json("bake map.exr -o bake.exr --tracer slice --target-error 0.01");
  EXPECT_EQ(json["rays"], json["choice"]["rays"]);
  EXPECT_EQ(json["bounces"], json["choice"]["bounces"]);
  EXPECT_EQ(json["target_error"], 0.01);
  // A sample of a quarter of a small map knows the error to about a third.
  EXPECT_LT(json["reached_error_ao"].get<double>(), 0.014);
  EXPECT_LT(json["reached_error_albedo_0.5"].get<double>(), 0.014);
  EXPECT_GT(json["reached_error_ao"].get<double>(), 0.001);
}

TEST_F(TargetErrorOption, IsExplained) {
  const std::string text = run_well("bake map.exr -o bake.exr --target-error 0.02 --explain").standard_output;
  for (const char* part : {"target ", "pilot ", "bounces ", "rays ", "reached "})
    EXPECT_THAT(text, HasSubstr(part));
  EXPECT_THAT(run_well("bake map.exr --dry-run --target-error 0.02 --explain").standard_output,
              HasSubstr("power law"));
}

TEST_F(TargetErrorOption, OfSkyAloneTracesNoLinks) {
  const auto json = run_json("bake map.exr -o bake.exr --tracer slice --target-error 0.01 --outputs ao");
  EXPECT_EQ(json["choice"]["bounces"], 0);
  EXPECT_FALSE(json.contains("links"));
}

TEST_F(TargetErrorOption, GivesTheSameBytesAtAnyThreadCount) {
  run_well("bake map.exr -o one.exr --tracer slice --target-error 0.01 --threads 1");
  run_well("bake map.exr -o four.exr --tracer slice --target-error 0.01 --threads 4");
  EXPECT_EQ(read_bytes(folder_ / "one.exr"), read_bytes(folder_ / "four.exr"));
}

TEST_F(TargetErrorOption, RefusesWhatContradictsIt) {
  const std::string bake = "bake map.exr -o bake.exr ";
  expect_refusal(bake + "--target-error 0.01 --rays 64", HasSubstr("--rays: is chosen by --target-error"));
  expect_refusal(bake + "--target-error 0.01 --bounces 4", HasSubstr("--bounces"));
  expect_refusal(bake + "--target-error 0.01 --tracer march", HasSubstr("--tracer embree or slice"));
  expect_refusal(bake + "--target-error 0.01 --max-distance 1", HasSubstr("--max-distance"));
  expect_refusal(bake + "--explain", HasSubstr("--explain"));
  for (const char* value : {"0", "-1", "nan", "1e-9", "2"})
    expect_refusal(bake + "--target-error " + value, HasSubstr("--target-error"));
}

}  // namespace
}  // namespace hemibake
