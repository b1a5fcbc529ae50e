// Refusal of option values that make no sense: by name, with the value expected, before any work.
#include <fmt/format.h>

#include "cli/run_hemibake.h"

namespace hemibake {
namespace {

using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::StartsWith;

class BadOptions : public CliTest {
 protected:
  void SetUp() override { write_map("map.png", SyntheticKind::kShapes, 8, 8); }

  void expect_bad(const std::string& command, const std::string& option, const std::string& value,
                  const testing::Matcher<std::string>& expectation) const {
    expect_refusal(fmt::format("{} {} '{}'", command, option, value),
                   AllOf(StartsWith(option + ": "), HasSubstr(value), expectation));
  }
};

struct BadValue {
  const char* option;
  const char* value;
};

// Every option of a bake with a value just outside its range; validators_test.cpp tests the notation of
// numbers.
TEST_F(BadOptions, OfABake) {
  for (const auto& [option, value] : std::vector<BadValue>{{"--size", "0"},
                                                           {"--size", "nan"},
                                                           {"--amplitude", "-1"},
                                                           {"--amplitude", "inf"},
                                                           {"--cone", "0"},
                                                           {"--cone", "181"},
                                                           {"--max-distance", "0"},
                                                           {"--converge", "0"},
                                                           {"--converge", "12abc"},
                                                           {"--memory", "0"}})
    expect_bad("bake map.png -o bake.exr", option, value, HasSubstr("expected a number"));
  for (const auto& [option, value] : std::vector<BadValue>{{"--rays", "0"},
                                                           {"--rays", "1048577"},
                                                           {"--rays", "12abc"},
                                                           {"--bounces", "1001"},
                                                           {"--bounces", "-1"},
                                                           {"--max-bounces", "0"},
                                                           {"--seed", "-1"},
                                                           {"--seed", "18446744073709551616"},
                                                           {"--threads", "-1"},
                                                           {"--threads", "1025"}})
    expect_bad("bake map.png -o bake.exr", option, value, HasSubstr("expected a whole number"));
  for (const std::string option : {"--edge", "--tracer", "--directions", "--patches", "--texel-links",
                                   "--outputs", "--normal-y", "--normals-from"})
    expect_bad("bake map.png -o bake.exr", option, "cubes", HasSubstr("not in {"));
  expect_bad("bake map.png -o bake.exr", "--outputs", "cubes", HasSubstr("not in {"));
  expect_refusal("bake map.png -o bake.exr --channel Q",
                 "map.png: has no channel 'Q', expected the name or index of one of its channels: Y");
}

TEST_F(BadOptions, TexelsOffTheMap) {
  const std::string line = "map.png: there is no texel 8,0, expected 0,0 to 7,7";
  expect_refusal("bake map.png --replay 8,0", line);
  expect_refusal("bake map.png --replay 0,8", HasSubstr("there is no texel 0,8"));
  for (const std::string value : {"-1,0", "0,a", "99999999999,0"})
    expect_refusal("bake map.png --replay " + value,
                   AllOf(StartsWith("--replay: "), HasSubstr("expected a whole number")));
  for (const std::string value : {"1", "1,2,3"})
    expect_refusal("bake map.png --replay " + value, StartsWith("--replay: "));
}

TEST_F(BadOptions, CombinationsOfABake) {
  expect_refusal("bake map.png -o bake.exr --outputs ao --converge 1e-5", StartsWith("--converge: "));
  expect_refusal("run map.png -o results --outputs ao,bent",
                 AllOf(StartsWith("--outputs: "), HasSubstr("expected")));
  expect_refusal("bake map.png", AllOf(StartsWith("--output: "), HasSubstr("expected")));
  expect_refusal(
      "bake map.png --texel 5,7",
      "--texel is the width of a texel in metres, expected -o BAKE.exr with it; --replay X,Y prints what "
      "one texel sees");
}

TEST_F(BadOptions, MemoryIsRefusedBeforeTheWork) {
  // A million rays per texel would take minutes.
  const std::string lots = " --memory 0.001 --rays 1048576";
  const auto line = AllOf(StartsWith("map.png: has 8 x 8 texels, which need 0."),
                          HasSubstr("GiB, expected at most the 0.001 GiB of --memory: "));
  expect_refusal("bake map.png -o bake.exr" + lots, line);
  expect_refusal("run map.png -o results" + lots, line);
}

// The first value is infinite: whoever reads it says so.
TEST_F(BadOptions, MemoryIsRefusedByTheHeader) {
  write_bytes(folder_ / "large.raw", std::string("\0\0\x80\x7f", 4));
  std::filesystem::resize_file(folder_ / "large.raw", 4 * 3000 * 3000);
  const std::string large = "large.raw --raw 3000x3000:f32le --memory 0.5";
  const auto line = AllOf(StartsWith("large.raw: has 3000 x 3000 texels, which need "),
                          HasSubstr("GiB, expected at most the 0.5 GiB of --memory: "));
  expect_refusal("bake " + large + " -o bake.exr --outputs ao", line);
  expect_refusal("bake " + large + " -o bake.exr --outputs ao --tracer embree --edge open", line);
  expect_refusal("run " + large + " -o results", line);
  expect_refusal("textures " + large + " -o textures --maps ao", line);
  // These need no more than reading does.
  expect_refusal("bake " + large + " --dry-run", HasSubstr("inf"));
  expect_refusal("textures " + large + " -o textures --maps svf", HasSubstr("inf"));
}

TEST_F(BadOptions, OfTheOtherCommands) {
  expect_bad("curves done.exr -o c.csv", "--bins", "0", HasSubstr("expected a whole number"));
  expect_bad("run map.png -o results", "--bins", "65537", HasSubstr("expected a whole number"));
  expect_bad("run map.png -o results", "--size", "nan", HasSubstr("expected a number"));
  for (const std::string option : {"--model", "--abscissa", "--weights"})
    expect_bad("fit done.csv -o f.json", option, "cubic", HasSubstr("not in {"));
  for (const std::string value : {"0", "nan", "2"})
    expect_bad("check done.exr", "--tolerance", value, HasSubstr("expected a number"));
  for (const std::string option : {"--width", "--height", "--seed"})
    expect_bad("synth noise -o m.exr", option, "-1", HasSubstr("expected a whole number"));
  for (const std::string value : {"0", "90", "nan"})
    expect_bad("synth bowl -o m.exr", "--angle", value, HasSubstr("expected a number"));
}

TEST_F(BadOptions, UnknownMissingAndDouble) {
  expect_refusal("", StartsWith("no command, expected one of synth, bake, "));
  expect_refusal("cook map.png", StartsWith("'cook' is no command, expected one of synth, bake, "));
  expect_refusal("bake map.png -o bake.exr --size ''",
                 StartsWith("--size: is followed by an empty argument"));
  expect_refusal("bake map.png -o bake.exr --albedo 1", HasSubstr("--albedo"));
  expect_refusal("bake map.png other.png -o bake.exr",
                 HasSubstr("--output: bake.exr is one file, expected a folder"));
  expect_refusal("bake map.png -o bake.exr --size 1 --size 2", HasSubstr("--size"));
  expect_refusal("bake map.png -o bake.exr --size", HasSubstr("--size"));
  expect_refusal("bake -o bake.exr", HasSubstr("MAP"));
  expect_refusal("run map.png", HasSubstr("--output"));
  expect_refusal("curves done.exr", HasSubstr("--output"));
  expect_refusal("fit -o f.json", HasSubstr("CURVES"));
  expect_refusal("check", HasSubstr("FILE"));
  expect_refusal("synth -o m.exr", HasSubstr("KIND"));
  expect_refusal("bake 'two\nlines.png' -o bake.exr", HasSubstr("two lines.png"));
}

}  // namespace
}  // namespace hemibake
