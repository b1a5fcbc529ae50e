// Commands that are killed at any moment: what they wrote is whole or not there, and the next run does its
// work.
#include <fmt/format.h>

#include <chrono>

#include "cli/run_hemibake.h"
#include "sampling/low_discrepancy.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

constexpr int kMoments = 4;
constexpr int kKilled = 128 + 9;
constexpr uint64_t kStream = 9;

class Killed : public CliTest {
 protected:
  // Kills a command that writes into the folder `out` at random moments of its run, and runs it again after
  // each. arguments: with the outputs below out/. inputs: copied to out/ beforehand, each time.
  void expect_whole_or_absent(const std::string& arguments, const std::string& inputs = "") const {
    const auto begin = std::chrono::steady_clock::now();
    begin_anew(inputs);
    run_well(arguments);
    const std::chrono::duration<double> whole_run = std::chrono::steady_clock::now() - begin;
    const std::map<std::string, std::string> whole = outputs();
    ASSERT_FALSE(whole.empty());
    int killed = 0;
    for (int moment = 0; moment < kMoments; ++moment) {
      begin_anew(inputs);
      const double share = (moment + unit_interval(mix_bits(1, kStream, moment))) / kMoments;
      const CommandResult result = run_killed(arguments, share * whole_run.count());
      if (result.exit_code == kKilled) ++killed;
      for (const auto& [name, bytes] : outputs()) {
        if (name.find("/.") != std::string::npos || name.starts_with('.')) continue;  // not removed yet
        const auto right = whole.find(name);
        ASSERT_NE(right, whole.end()) << name << " after " << share << " of: " << arguments;
        EXPECT_TRUE(bytes == right->second) << name << " after " << share << " of: " << arguments;
      }
      run_well(arguments);
      EXPECT_TRUE(outputs() == whole) << "again after " << share << " of: " << arguments;
    }
    EXPECT_GT(killed, 0) << arguments;
  }

  // Kills a run after so many seconds, where it is not at its end by then.
  CommandResult run_killed(const std::string& arguments, double seconds) const {
    return run_shell(fmt::format("cd '{}' && timeout -s KILL {} '{}' {}", folder_.path().string(), seconds,
                                 HEMIBAKE_BINARY, arguments));
  }

  // Returns the bytes of every file below out/.
  std::map<std::string, std::string> outputs() const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / "out"))
      if (entry.is_regular_file())
        files[fs::relative(entry.path(), folder_ / "out").string()] = read_bytes(entry.path());
    return files;
  }

 private:
  void begin_anew(const std::string& inputs) const {
    fs::remove_all(folder_ / "out");
    fs::create_directory(folder_ / "out");
    if (!inputs.empty()) fs::copy(folder_ / inputs, folder_ / "out", fs::copy_options::recursive);
  }
};

TEST_F(Killed, BakeWithLinks) {
  write_map("map.exr", SyntheticKind::kBricks, 48, 40);
  expect_whole_or_absent("bake map.exr -o out/bake.exr --links out/links.h5 --rays 64");
}

TEST_F(Killed, Run) {
  write_map("map.exr", SyntheticKind::kBricks, 48, 40);
  expect_whole_or_absent("run map.exr -o out/results --rays 64");
}

TEST_F(Killed, Render) {
  write_map("map.exr", SyntheticKind::kBricks, 24, 20);
  run_well("bake map.exr -o bake.exr --rays 64");
  expect_whole_or_absent("render bake.exr -o out/pictures");
}

TEST_F(Killed, Textures) {
  write_map("map.exr", SyntheticKind::kBricks, 48, 40);
  run_well("bake map.exr -o bake.exr --rays 64");
  expect_whole_or_absent("textures bake.exr -o out/textures --format png16");
}

TEST_F(Killed, Report) {
  write_map("map.exr", SyntheticKind::kBricks, 48, 40);
  run_well("run map.exr -o results --rays 64");
  if (run("report results -o page.html").exit_code != 0) GTEST_SKIP() << "this build has no report";
  expect_whole_or_absent("report out", "results");
}

// A study records how long it took: never the same bytes twice.
TEST_F(Killed, Trade) {
  write_map("map.exr", SyntheticKind::kBricks, 12, 10);
  const std::string trade = "trade map.exr -o out --effort quick";
  fs::create_directory(folder_ / "out");
  for (int moment = 0; moment < 3; ++moment) {
    run_killed(trade, 0.3 + unit_interval(mix_bits(2, kStream, moment)));
    for (const auto& [name, bytes] : outputs())
      if (name.ends_with(".json")) {
        EXPECT_FALSE(nlohmann::json::parse(bytes, nullptr, false).is_discarded()) << name;
      }
  }
  run_well(trade);
  EXPECT_TRUE(outputs().contains("trade.json"));
}

}  // namespace
}  // namespace hemibake
