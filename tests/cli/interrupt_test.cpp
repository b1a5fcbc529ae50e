// Interruption by Ctrl-C, SIGTERM and SIGHUP in the middle of the work: exit code 130, no file left behind.
#include <fmt/format.h>

#include "cli/run_hemibake.h"

namespace hemibake {
namespace {

class Interrupt : public CliTest {
 protected:
  // Sends `signal` once to work that would take minutes, after it has begun. A second one would kill.
  void expect_clean_end(const std::string& arguments, const std::string& signal) const {
    const auto files = listing();
    const CommandResult result = run_interrupted(arguments, signal);
    EXPECT_EQ(result.exit_code, 130) << arguments;
    EXPECT_EQ(result.standard_output, "");
    EXPECT_EQ(result.standard_error, "hemibake: interrupted, no file was left half written\n");
    EXPECT_EQ(listing(), files) << arguments;
  }
};

// 200 million rays.
TEST_F(Interrupt, WhileTracing) {
  write_map("map.exr", SyntheticKind::kBricks, 512, 512);
  write_bytes(folder_ / "old.exr", "the bake of yesterday");
  expect_clean_end("bake map.exr -o new.exr --links links.h5", "INT");
  expect_clean_end("bake map.exr -o old.exr", "TERM");
  expect_clean_end("run map.exr -o results", "INT");
}

// Links between texels of a rough map trap light: a million bounces do not bring it out.
TEST_F(Interrupt, WhileBouncing) {
  write_map("map.exr", SyntheticKind::kNoise, 64, 64);
  expect_clean_end(
      "bake map.exr -o new.exr --rays 64 --amplitude 1 --patches texels --converge 1e-12 --max-bounces "
      "1000000",
      "TERM");
}

// A terminal that closes ends a run as Ctrl-C does, but not one under `nohup`.
TEST_F(Interrupt, ByATerminalThatCloses) {
  write_map("map.exr", SyntheticKind::kBricks, 512, 512);
  expect_clean_end("bake map.exr -o new.exr", "HUP");
}

TEST_F(Interrupt, IgnoredSignalsStayIgnored) {
  write_map("map.exr", SyntheticKind::kBricks, 64, 64);
  for (const char* signal : {"HUP", "INT", "TERM"}) {
    const CommandResult result = run_shell(fmt::format(
        "cd '{}' && trap '' {} && {{ '{}' bake map.exr -o out.exr --rays 1024 & }} && pid=$! && sleep 0.3 && "
        "kill -{} $pid; wait $pid",
        folder_.path().string(), signal, HEMIBAKE_BINARY, signal));
    EXPECT_EQ(result.exit_code, 0) << signal << "\n" << result.standard_error;
  }
}

}  // namespace
}  // namespace hemibake
