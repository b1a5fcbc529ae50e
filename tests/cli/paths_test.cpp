// A bake finds its map again from any folder, and textures say nothing of the maker's folders.
#include <fmt/format.h>

#include "cli/run_hemibake.h"
#include "io/image_io.h"

namespace hemibake {
namespace {

using testing::HasSubstr;
using testing::Not;

class Paths : public CliTest {
 protected:
  void SetUp() override {
    for (const char* name : {"work", "work/maps", "work/out", "elsewhere"})
      std::filesystem::create_directory(folder_ / name);
    write_map("work/maps/map.exr", SyntheticKind::kBricks, 8, 8);
  }
  // `check --referee` reads the map of the bake.
  CommandResult judge(const std::string& bake, const std::string& from) const {
    return run_shell(fmt::format("cd '{}' && '{}' check {} --referee --texels 8 --paths 4",
                                 (folder_ / from).string(), HEMIBAKE_BINARY, bake));
  }
};

TEST_F(Paths, ABakeFindsItsMapFromAnyFolder) {
  run_shell(fmt::format("cd '{}' && '{}' bake maps/map.exr -o out/bake.exr --rays 8 --bounces 2",
                        (folder_ / "work").string(), HEMIBAKE_BINARY));
  for (const auto& [bake, from] :
       {std::pair("out/bake.exr", "work"), std::pair("../work/out/bake.exr", "elsewhere"),
        std::pair("bake.exr", "work/out")})
    EXPECT_LE(judge(bake, from).exit_code, 1) << from << judge(bake, from).standard_error;
}

TEST_F(Paths, BakeAndMapMoveTogether) {
  run_well("bake work/maps/map.exr -o work/out/bake.exr --rays 8 --bounces 2");
  std::filesystem::rename(folder_ / "work", folder_ / "moved");
  EXPECT_LE(judge("moved/out/bake.exr", ".").exit_code, 1);
  // Another map of that name in the first place is passed over for the right one beside the bake.
  std::filesystem::rename(folder_ / "moved/maps/map.exr", folder_ / "moved/out/map.exr");
  write_map("moved/maps/map.exr", SyntheticKind::kNoise, 8, 8);
  EXPECT_LE(judge("moved/out/bake.exr", ".").exit_code, 1);
  std::filesystem::remove(folder_ / "moved/out/map.exr");
  EXPECT_THAT(judge("moved/out/bake.exr", ".").standard_error,
              HasSubstr("not the file the bake was made from"));
}

TEST_F(Paths, TexturesHaveNoFoldersOfTheMaker) {
  const std::string map = (folder_ / "work/maps/map.exr").string();
  run_well("textures " + map + " -o t --rays 8 --maps ao");
  run_well("bake " + map + " -o b.exr --rays 8 --outputs ao");
  run_well("textures b.exr -o u --maps ao");
  for (const char* texture : {"t/map_ao.png", "u/b_ao.png"}) {
    Provenance made = read_image_header(folder_ / texture).provenance;
    for (const char* typed : {"command", "bake_command"}) made.erase(typed);
    EXPECT_THAT(made.dump(), Not(HasSubstr("maps/"))) << texture;
  }
}

}  // namespace
}  // namespace hemibake
