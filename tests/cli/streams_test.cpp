// Standard streams that are closed or full: the right exit code, whole files, no abort.
#include <fmt/format.h>

#include "cli/run_hemibake.h"

namespace hemibake {
namespace {

using testing::HasSubstr;

class Streams : public CliTest {
 protected:
  void SetUp() override {
    write_map("map.exr", SyntheticKind::kShapes, 32, 32);
    run_well("run map.exr --rays 16 -o results");
    std::filesystem::copy_file(folder_ / "results/curves.csv", folder_ / "other.csv");
  }

  const std::vector<std::string> commands_ = {"synth shapes --width 32 --height 32 -o out.exr",
                                              "bake map.exr --rays 4 -o out.exr --links out.h5",
                                              "textures results/bake.exr -o textures",
                                              "curves results/bake.exr -o out.csv",
                                              "fit results/curves.csv -o out.json",
                                              "compare results/curves.csv other.csv",
                                              "export results/fit.json -o out.glsl",
                                              "render results/bake.exr --pictures planes -o pictures",
                                              "check results/bake.exr",
                                              "run map.exr --rays 4 -o results2",
                                              "report results -o out.html",
                                              "--help",
                                              "bake --help",
                                              "--version"};
};

TEST_F(Streams, OutputThatTakesNothing) {
  for (const std::string& command : commands_)
    for (const char* stream : {">&-", ">/dev/full", "--json >&-", "<&- >&-"}) {
      if (command.find("--") == 0 && std::string(stream).starts_with("--json")) continue;
      const CommandResult result = run(command + " " + stream);
      EXPECT_EQ(result.exit_code, 2) << command << " " << stream << "\n" << result.standard_error;
      EXPECT_THAT(result.standard_error, HasSubstr("hemibake: standard output: could not write: "))
          << command << " " << stream;
    }
}

TEST_F(Streams, OthersThatAreClosedOrFull) {
  for (const std::string& command : commands_) {
    const int expected = run(command).exit_code;
    for (const char* stream : {"2>&-", "2>/dev/full", "<&-", "<&- 2>&-", "</dev/full"})
      EXPECT_EQ(run(command + " " + stream).exit_code, expected) << command << " " << stream;
  }
  EXPECT_EQ(run(">&- 2>&- <&-").exit_code, 2);
  EXPECT_EQ(run("check none.exr 2>/dev/full").exit_code, 2);
  EXPECT_EQ(run("check none.exr 2>&-").exit_code, 2);
}

// A file opened in place of a closed stream would take what is printed.
TEST_F(Streams, NoFileTakesTheNumberOfAClosedStream) {
  run_well("curves results/bake.exr -o expected.csv");
  run("curves results/bake.exr -o out.csv <&- >&- 2>&-");
  EXPECT_EQ(read_bytes(folder_ / "out.csv"), read_bytes(folder_ / "expected.csv"));
}

TEST_F(Streams, NamesLoseTheirControlCharacters) {
  const CommandResult result = run("check 'no\x1b[31m\x07ne.exr'");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.standard_error.find('\x1b'), std::string::npos);
  EXPECT_EQ(result.standard_error.find('\x07'), std::string::npos);
}

}  // namespace
}  // namespace hemibake
