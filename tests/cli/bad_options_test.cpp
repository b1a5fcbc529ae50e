// Option values that make no sense, one by one: refused by name, with what was expected, before any work.
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
  void SetUp() override {
    run_well("synth shapes --width 8 --height 8 -o map.png");
    run_well("bake map.png -o done.exr --rays 4");
    run_well("curves done.exr -o done.csv --bins 10");
  }

  void expect_bad(const std::string& command, const std::string& option, const std::string& value,
                  const testing::Matcher<std::string>& expectation) const {
    expect_refusal(fmt::format("{} {} '{}'", command, option, value),
                   AllOf(StartsWith(option + ": "), HasSubstr(value), expectation));
  }
};

const std::vector<std::string> kNoNumbers = {"nan", "inf",   "-inf",    "12abc", "",
                                             "1,5", "1e999", "one two", "--",    "1 2"};
// What is a number, but for decimal digits only.
const std::vector<std::string> kNoWholeNumbers = {
    "1.5", "1e3", "0x10", "010", "-1", "+1", "99999999999999999999"};

// Length by length, angle by angle.
TEST_F(BadOptions, RealNumbersOfABake) {
  struct Case {
    const char* option;
    std::vector<std::string> outside;
  };
  for (const std::string command : {"bake map.png -o bake.exr", "run map.png -o results"})
    for (const Case& bad : std::vector<Case>{{"--size", {"0", "-1", "1e10", "1e300"}},
                                             {"--amplitude", {"-1", "-1e-300", "1e10"}},
                                             {"--cone", {"0", "-90", "181", "180.0001"}},
                                             {"--max-distance", {"0", "-1"}},
                                             {"--converge", {"0", "-1e-5", "1.5"}},
                                             {"--memory", {"0", "-1"}}}) {
      for (const std::string& value : bad.outside)
        expect_bad(command, bad.option, value, HasSubstr("expected a number"));
      for (const std::string& value : kNoNumbers) {
        if (command[0] == 'r' && value != "nan" && value != "12abc") continue;  // the same definition
        if (value == "--") continue;
        expect_bad(command, bad.option, value, HasSubstr("expected a number"));
      }
    }
}

TEST_F(BadOptions, WholeNumbersOfABake) {
  struct Case {
    const char* option;
    std::vector<std::string> outside;
  };
  for (const Case& bad : std::vector<Case>{{"--rays", {"0", "1048577"}},
                                           {"--bounces", {"1001"}},
                                           {"--max-bounces", {"0", "1000001"}},
                                           {"--seed", {"18446744073709551616"}},
                                           {"--threads", {"1025"}}}) {
    std::vector<std::string> values = bad.outside;
    values.insert(values.end(), kNoWholeNumbers.begin(), kNoWholeNumbers.end());
    values.insert(values.end(), {"nan", "12abc", ""});
    for (const std::string& value : values)
      expect_bad("bake map.png -o bake.exr", bad.option, value, HasSubstr("expected a whole number"));
    expect_bad("run map.png -o results", bad.option, bad.outside[0], HasSubstr("expected a whole number"));
  }
}

TEST_F(BadOptions, ChoicesOfABake) {
  for (const std::string command : {"bake map.png -o bake.exr", "run map.png -o results"})
    for (const std::string option : {"--edge", "--tracer", "--directions", "--patches", "--texel-links",
                                     "--outputs", "--normal-y", "--normals-from"})
      for (const std::string value : {"cubes", "", "WRAP "})
        expect_bad(command, option, value, HasSubstr("not in {"));
  expect_bad("bake map.png -o bake.exr", "--channel", "Q", AnyOf(HasSubstr("expected")));
}

TEST_F(BadOptions, TexelsOffTheMap) {
  const std::string line = "map.png: there is no texel 8,0, expected 0,0 to 7,7";
  expect_refusal("bake map.png --texel 8,0", line);
  expect_refusal("bake map.png --texel 0,8", HasSubstr("there is no texel 0,8"));
  for (const std::string value : {"-1,0", "0,-1", "a,0", "1.5,0", "nan,0", "99999999999,0"})
    expect_refusal("bake map.png --texel " + value,
                   AllOf(StartsWith("--texel: "), HasSubstr("expected a whole number")));
  for (const std::string value : {"1", "1,2,3", "''"})
    expect_refusal("bake map.png --texel " + value, StartsWith("--texel: "));
}

TEST_F(BadOptions, CombinationsOfABake) {
  expect_refusal("bake map.png -o bake.exr --outputs ao --converge 1e-5", StartsWith("--converge: "));
  expect_refusal("run map.png -o results --outputs ao,bent",
                 AllOf(StartsWith("--outputs: "), HasSubstr("expected")));
  expect_refusal("bake map.png", AllOf(StartsWith("--output: "), HasSubstr("expected")));
}

TEST_F(BadOptions, MemoryIsRefusedBeforeTheWork) {
  // A million rays per texel would take minutes.
  const std::string lots = " --memory 0.001 --rays 1048576";
  const auto line =
      AllOf(StartsWith("map.png: the bake needs "), HasSubstr("expected at most the 0.001 GiB of --memory"));
  expect_refusal("bake map.png -o bake.exr" + lots, line);
  expect_refusal("run map.png -o results" + lots, line);
}

TEST_F(BadOptions, OfTheOtherCommands) {
  for (const std::string value : {"0", "65537", "-1", "nan", "12abc", "", "1e2", "2.5"}) {
    expect_bad("curves done.exr -o c.csv", "--bins", value, HasSubstr("expected a whole number"));
    expect_bad("run map.png -o results", "--bins", value, HasSubstr("expected a whole number"));
  }
  for (const std::string option : {"--model", "--abscissa", "--weights"})
    for (const std::string value : {"cubic", ""})
      expect_bad("fit done.csv -o f.json", option, value, HasSubstr("not in {"));
  for (const std::string value : {"0", "-1", "2", "nan", "inf", "1e-5x", ""})
    expect_bad("check done.exr", "--tolerance", value, HasSubstr("expected a number"));
  for (const std::string option : {"--width", "--height"})
    for (const std::string value : {"0", "-1", "nan", "12abc", "", "1e3", "99999999999"})
      expect_bad("synth noise -o m.exr", option, value, HasSubstr("expected a whole number"));
  for (const std::string value : {"0", "90", "nan", "inf", "-45", "45deg", ""})
    expect_bad("synth bowl -o m.exr", "--angle", value, HasSubstr("expected a number"));
  expect_bad("synth noise -o m.exr", "--seed", "18446744073709551616", HasSubstr("expected a whole number"));
}

TEST_F(BadOptions, UnknownMissingAndDouble) {
  expect_refusal("", testing::Not(""));
  expect_refusal("cook map.png", HasSubstr("cook"));
  expect_refusal("bake map.png -o bake.exr --albedo 1", HasSubstr("--albedo"));
  expect_refusal("bake map.png other.png -o bake.exr", HasSubstr("other.png"));
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
