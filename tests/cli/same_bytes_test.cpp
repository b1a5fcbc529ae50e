// The bytes of every file are the same on every run, at any thread count and with every instruction set.
#include "cli/run_hemibake.h"
#include "tracers/slice/instruction_sets.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

class SameBytes : public CliTest {
 protected:
  void expect_same(const std::string& options) const {
    for (const std::string name : {"one", "again", "two"}) {
      fs::create_directory(folder_ / name);
      const CommandResult result = run("run ../map.exr -o results --links links.h5 " + options +
                                           (name == "two" ? " --threads 2" : " --threads 1"),
                                       "cd " + name + " &&");
      ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    }
    for (const std::string file :
         {"results/bake.exr", "results/curves.csv", "results/fit.json", "results/check.json", "links.h5"}) {
      const std::string bytes = read_bytes(folder_.path() / "one" / file);
      EXPECT_FALSE(bytes.empty()) << file;
      EXPECT_TRUE(bytes == read_bytes(folder_.path() / "again" / file)) << file << " differs on repetition";
      EXPECT_TRUE(bytes == read_bytes(folder_.path() / "two" / file)) << file << " differs with two threads";
    }
  }
};

TEST_F(SameBytes, WithFacets) {
  write_map("map.exr", SyntheticKind::kBricks, 96, 80);
  expect_same("--rays 64");
}

TEST_F(SameBytes, WithTexelsAndOpenEdges) {
  write_map("map.exr", SyntheticKind::kShapes, 96, 80);
  expect_same("--rays 64 --amplitude 0.45 --patches texels --edge open");
}

// One binary serves every machine of its kind: slices and bounces run on the best instructions that it has.
TEST_F(SameBytes, WithEveryInstructionSet) {
  write_map("map.exr", SyntheticKind::kBricks, 48, 40);
  const std::vector<std::string> sets = instruction_sets();
  ASSERT_FALSE(sets.empty());
  for (const std::string& set : sets) {
    fs::create_directory(folder_ / set);
    const CommandResult result = run("run ../map.exr -o results --links links.h5 --rays 32",
                                     "cd " + set + " && HEMIBAKE_TARGETS=" + set);
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    for (const std::string file :
         {"results/bake.exr", "results/curves.csv", "results/fit.json", "links.h5"}) {
      const std::string bytes = read_bytes(folder_.path() / set / file);
      EXPECT_FALSE(bytes.empty()) << file;
      EXPECT_TRUE(bytes == read_bytes(folder_.path() / sets[0] / file)) << file << " differs with " << set;
    }
  }
  const CommandResult unknown = run("synth flat -o flat.exr", "HEMIBAKE_TARGETS=none");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.standard_error, testing::HasSubstr("expected one of " + sets[0]));
}

// glibc chooses exp, pow and others by the processor; without FMA their last bits are others.
TEST_F(SameBytes, OnAMachineWithoutFma) {
  write_map("map.exr", SyntheticKind::kBricks, 64, 64);
  const std::string without = "GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX2_Usable";
  for (const std::string name : {"with", "without"}) {
    const CommandResult result =
        run("run map.exr --rays 32 -o " + name, name == "without" ? "export " + without + ";" : "");
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
  }
  for (const std::string file : {"bake.exr", "curves.csv", "fit.json", "check.json"})
    EXPECT_TRUE(read_bytes(folder_.path() / "with" / file) == read_bytes(folder_.path() / "without" / file))
        << file;
}

}  // namespace
}  // namespace hemibake
