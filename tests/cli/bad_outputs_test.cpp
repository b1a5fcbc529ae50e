// Refusal of places that cannot be written to: at once, or, where the disk fills, without a trace.
#include <fmt/format.h>
#include <unistd.h>

#include "cli/run_hemibake.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::StartsWith;

class BadOutputs : public CliTest {
 protected:
  void SetUp() override {
    write_map("map.exr", SyntheticKind::kShapes, 64, 64);
    // Input for curves and fit, which they must not reach.
    write_bytes(folder_ / "done.exr", "no bake");
    write_bytes(folder_ / "done.csv", "no curves");
  }

  void make_results() const {
    run_well("bake map.exr -o done.exr --rays 4");
    run_well("curves done.exr -o done.csv --bins 10");
  }

  struct Line {
    std::string command;  // up to the output's name
    std::string suffix;
  };
  // A million rays per texel: a refusal that comes only after the work would time out.
  const std::vector<Line> lines_ = {{"synth shapes --width 64 --height 64 -o ", ".exr"},
                                    {"bake map.exr --rays 1048576 -o ", ".exr"},
                                    {"bake map.exr --rays 1048576 -o links_go_elsewhere.exr --links ", ".h5"},
                                    {"curves done.exr -o ", ".csv"},
                                    {"fit done.csv -o ", ".json"}};
};

TEST_F(BadOutputs, MissingFolder) {
  for (const Line& line : lines_)
    expect_refusal(
        line.command + "none/out" + line.suffix,
        AllOf(StartsWith("none/out" + line.suffix + ": could not write"), HasSubstr("No such file")));
  expect_refusal("run map.exr --rays 1048576 -o none/results",
                 AllOf(StartsWith("none/results: "), HasSubstr("expected a folder or a new name in one")));
}

TEST_F(BadOutputs, FolderInItsPlace) {
  for (const Line& line : lines_) {
    fs::create_directory(folder_ / ("folder" + line.suffix));
    expect_refusal(line.command + "folder" + line.suffix,
                   AllOf(StartsWith("folder" + line.suffix + ": is a folder"), HasSubstr("expected")));
  }
  fs::create_directories(folder_ / "results" / "curves.csv");
  expect_refusal("run map.exr --rays 1048576 -o results", StartsWith("results/curves.csv: is a folder"));
  expect_refusal("run map.exr --rays 1048576 -o map.exr", StartsWith("map.exr: could not make the folder"));
}

TEST_F(BadOutputs, WrongSuffix) {
  for (const Line& line : lines_) {
    expect_refusal(line.command + "out.txt", AllOf(StartsWith("out.txt: cannot write '.txt' files"),
                                                   HasSubstr("expected " + std::string(line.suffix))));
    expect_refusal(line.command + "out",
                   AllOf(StartsWith("out: "), HasSubstr("expected " + std::string(line.suffix))));
  }
}

TEST_F(BadOutputs, EmptyNames) {
  expect_refusal("bake map.exr -o ''", "-o: is followed by an empty argument, expected a name or a value");
  expect_refusal("bake map.exr -o out.exr --links ''",
                 StartsWith("--links: is followed by an empty argument"));
}

TEST_F(BadOutputs, TheInputItself) {
  expect_refusal("bake map.exr -o map.exr --rays 4",
                 "map.exr: is the input itself, expected another name for the output");
  expect_refusal("bake map.exr -o ./map.exr --rays 4", HasSubstr("is the input itself"));
  fs::create_symlink("map.exr", folder_ / "link.exr");
  expect_refusal("bake map.exr -o link.exr --rays 4", HasSubstr("is the input itself"));
  fs::create_directory(folder_ / "results");
  fs::copy_file(folder_ / "map.exr", folder_ / "results/bake.exr");
  expect_refusal("run results/bake.exr -o results --rays 4", HasSubstr("is the input itself"));
}

TEST_F(BadOutputs, FolderThatMayNotBeWritten) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  fs::create_directory(folder_ / "closed");
  fs::permissions(folder_ / "closed", fs::perms::owner_read | fs::perms::owner_exec);
  for (const Line& line : lines_)
    expect_refusal(line.command + "closed/out" + line.suffix, HasSubstr("Permission denied"));
  fs::permissions(folder_ / "closed", fs::perms::owner_all);
}

TEST_F(BadOutputs, DevicesAreNotReplaced) {
  fs::create_symlink("/dev/null", folder_ / "null.exr");
  expect_refusal("bake map.exr -o null.exr --rays 4", HasSubstr("is not a regular file"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

// Outputs larger than the limit on file sizes (ulimit counts blocks of 512 bytes in sh).
TEST_F(BadOutputs, FilesThatMayNotGrow) {
  make_results();
  const std::string limit = "ulimit -f 8;";
  const auto line = [](const std::string& name) { return name + ": could not write: File too large"; };
  expect_refusal("synth noise --width 64 --height 64 -o out.exr", line("out.exr"), limit);
  expect_refusal("synth noise --width 64 --height 64 -o out.png", line("out.png"), limit);
  expect_refusal("bake map.exr -o out.exr --rays 4", line("out.exr"), limit);
  expect_refusal("bake map.exr -o out.exr --rays 4 --links out.h5", line("out.h5"), limit);
  expect_refusal("curves done.exr -o out.csv --bins 1000", line("out.csv"), limit);
  expect_refusal("fit done.csv -o out.json", line("out.json"), "ulimit -f 1;");
  expect_refusal("run map.exr -o results --rays 4", line("results/bake.exr"), limit);
}

TEST_F(BadOutputs, FullDisk) {
  make_results();
  const SmallDisk disk;
  if (!disk.mounted()) GTEST_SKIP() << "may not mount a disk";
  const std::string at = (disk / "").string();
  write_map("large.exr", SyntheticKind::kNoise, 256, 256);
  const auto expect_full = [&](const std::string& arguments, const std::string& name) {
    expect_refusal(arguments, StartsWith(at + name + ": could not write: No space left on device"));
    EXPECT_EQ(disk.count(), 0U) << arguments;
  };
  expect_full("synth noise --width 256 --height 256 -o " + at + "out.exr", "out.exr");
  expect_full("bake large.exr --rays 4 --outputs ao,bent,normal -o " + at + "out.exr", "out.exr");
  expect_full("bake map.exr --rays 64 -o out.exr --links " + at + "out.h5", "out.h5");
  expect_full("run large.exr --rays 1 -o " + at + "results", "results/bake.exr");
}

TEST_F(BadOutputs, StandardOutputThatIsFull) {
  make_results();
  const CommandResult result = run("check done.exr --json >/dev/full");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.standard_error, "hemibake: standard output: could not write: No space left on device\n");
}

}  // namespace
}  // namespace hemibake
