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
  expect_refusal("bake map.exr -o ./map.exr --rays 4", HasSubstr("is the input map.exr itself"));
  fs::create_symlink("map.exr", folder_ / "link.exr");
  expect_refusal("bake map.exr -o link.exr --rays 4", HasSubstr("is the input map.exr itself"));
  fs::create_directory(folder_ / "results");
  fs::copy_file(folder_ / "map.exr", folder_ / "results/bake.exr");
  expect_refusal("run results/bake.exr -o results --rays 4", HasSubstr("is the input itself"));
}

// Commands that write beside or over what they read, by any name.
TEST_F(BadOutputs, NoCommandWritesOverItsInput) {
  run_well("run map.exr --rays 16 -o results");
  const auto link = [&](const char* target, const char* name) { fs::create_symlink(target, folder_ / name); };
  link("results/bake.exr", "link.csv");
  expect_refusal("curves results/bake.exr -o link.csv", HasSubstr("is the input results/bake.exr itself"));
  link("results/curves.csv", "link.json");
  expect_refusal("fit results/curves.csv -o link.json", HasSubstr("itself, expected another name"));
  expect_refusal("export results/fit.json -o results/fit.json --to glsl", HasSubstr("is the input itself"));
  link("results/bake.exr", "link.html");
  expect_refusal("report results -o link.html", HasSubstr("is the input results/bake.exr itself"));
  fs::create_hard_link(folder_ / "map.exr", folder_ / "hard.exr");
  expect_refusal("bake map.exr -o hard.exr --rays 4", HasSubstr("is the input map.exr itself"));
  link("both.exr", "both.h5");
  expect_refusal("bake map.exr -o both.exr --links both.h5 --rays 4",
                 HasSubstr("is the same file as both.exr"));
  fs::create_directory(folder_ / "pictures");
  link("../map.exr", "pictures/render.json");
  expect_refusal("render results/bake.exr -o pictures", HasSubstr("is the input"));
}

// The record of a folder can name anything; only pictures go.
TEST_F(BadOutputs, RenderRemovesOnlyPicturesOfRenders) {
  run_well("run map.exr --rays 16 -o results");
  run_well("render results/bake.exr --pictures planes -o results");
  write_bytes(folder_ / "results/mine.png", "mine");
  std::string record = read_bytes(folder_ / "results/render.json");
  const std::string list = "\"pictures\": [";
  record.insert(
      record.find(list) + list.size(),
      "{\"name\": \"x\", \"files\": [\"bake.exr\", \"curves.csv\", \"mine.png\", \"../map.exr\", 3]},");
  write_bytes(folder_ / "results/render.json", record);
  ASSERT_TRUE(fs::exists(folder_ / "results/ao.png"));
  run_well("render results/bake.exr --pictures saturation -o results");
  for (const char* name : {"results/bake.exr", "results/curves.csv", "results/mine.png", "map.exr"})
    EXPECT_TRUE(fs::exists(folder_ / name)) << name;
  EXPECT_FALSE(fs::exists(folder_ / "results/ao.png"));
}

// A run killed between two names leaves files of two runs.
TEST_F(BadOutputs, FilesOfTwoRunsAreTold) {
  run_well("run map.exr --rays 16 -o results");
  run_well("run map.exr --rays 17 -o others");
  run_well("report results -o page.html");
  for (const char* name : {"bake.exr", "curves.csv", "check.json"}) {
    const std::string before = read_bytes(folder_ / "results" / name);
    write_bytes(folder_ / "results" / name, read_bytes(folder_ / "others" / name));
    const std::string path = "results/" + std::string(name == std::string("check.json") ? "bake.exr" : name);
    expect_refusal("report results -o page.html",
                   HasSubstr(path + ": is not of the run that wrote check.json"));
    write_bytes(folder_ / "results" / name, before);
  }
  run_well("fit results/curves.csv -o results/fit.json --model visibility");
  run_well("report results -o page.html");
}

TEST_F(BadOutputs, LinksOfAnotherBakeAreTold) {
  run_well("bake map.exr -o a.exr --links a.h5 --rays 16");
  run_well("bake map.exr -o b.exr --links b.h5 --rays 17");
  run_well("render a.exr --links a.h5 --albedo 0.5 --sun 30,40,1 --pictures light -o pictures");
  expect_refusal("render a.exr --links b.h5 --albedo 0.5 --sun 30,40,1 --pictures light -o pictures",
                 "b.h5: is of another bake of this map, expected the links of this bake");
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
  EXPECT_EQ(result.standard_error,
            "hemibake: standard output: could not write: No space left on device, expected one that takes "
            "the result\n");
}

}  // namespace
}  // namespace hemibake
