// Interruption by Ctrl-C and SIGTERM in the middle of the work: exit code 130, no file left behind.
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

}  // namespace
}  // namespace hemibake
