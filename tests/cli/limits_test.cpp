// Commands that may use little memory and few files: they do their work or say in a line why not. Files that
// may not grow and full disks are in bad_outputs_test.cpp.
#include "cli/run_hemibake.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

class Limits : public CliTest {
 protected:
  void SetUp() override {
    write_map("map.exr", SyntheticKind::kBricks, 24, 20);
    run_well("run map.exr -o results --rays 16");
  }

  // Runs every command under a limit and expects it to end by itself: done, or with one line and no file.
  void expect_orderly(const std::string& limit) const {
    for (const std::string command :
         {"synth bricks -o out/map.png --width 32 --height 32",
          "bake map.exr -o out/bake.exr --links out/links.h5 --rays 16 --threads 2",
          "curves results/bake.exr -o out/curves.csv", "fit results/curves.csv -o out/fit.json",
          "textures results/bake.exr -o out/textures", "check results/bake.exr"}) {
      fs::remove_all(folder_ / "out");
      fs::create_directory(folder_ / "out");
      const CommandResult result = run(command, limit + " && ");
      const std::string where = limit + ": " + command + "\n" + result.standard_error;
      // 127: the loader of the system had too little for the libraries.
      if (result.exit_code == 0 || result.exit_code == 127) continue;
      EXPECT_EQ(result.exit_code, 2) << where;
      EXPECT_TRUE(result.standard_error.starts_with("hemibake: ")) << where;
      EXPECT_EQ(std::count(result.standard_error.begin(), result.standard_error.end(), '\n'), 1) << where;
      EXPECT_TRUE(fs::is_empty(folder_ / "out")) << where;
    }
  }
};

TEST_F(Limits, FewOpenFiles) {
  for (const int files : {4, 5, 6, 8, 12}) expect_orderly("ulimit -n " + std::to_string(files));
}

TEST_F(Limits, LittleMemory) {
  for (const int mebibytes : {500, 800}) expect_orderly("ulimit -v " + std::to_string(mebibytes * 1024));
}

}  // namespace
}  // namespace hemibake
