#include "io/output_check.h"

#include <gmock/gmock.h>

#include "io/io_testing.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(OutputCheck, FindsAnInputByAnyName) {
  const TemporaryFolder folder;
  write_bytes(folder / "in.exr", "x");
  fs::create_symlink("in.exr", folder / "link.exr");
  fs::create_hard_link(folder / "in.exr", folder / "hard.exr");
  fs::create_directory_symlink(".", folder / "again");
  const auto refusal = [&](const fs::path& output) {
    return error_of<InputError>([&] { refuse_overwriting_inputs({"", output}, {"", folder / "in.exr"}); });
  };
  EXPECT_THAT(refusal(folder / "in.exr"), HasSubstr("in.exr: is the input itself, expected another name"));
  for (const char* name : {"link.exr", "hard.exr", "again/in.exr", "./again/again/in.exr"})
    EXPECT_THAT(refusal(folder / name), HasSubstr("in.exr itself, expected another name for the output"));
  refuse_overwriting_inputs({folder / "out.exr"}, {folder / "in.exr", folder / "missing", "0.9,0.6,0.2"});
}

TEST(OutputCheck, FindsOutputsOfOneName) {
  const TemporaryFolder folder;
  fs::create_directory_symlink(".", folder / "again");
  fs::create_symlink("new.exr", folder / "link.exr");
  for (const char* name : {"new.exr", "again/new.exr", "link.exr"})
    EXPECT_THAT(error_of<InputError>([&] {
                  refuse_overwriting_inputs({folder / "new.exr", folder / name}, {});
                }),
                HasSubstr("is the same file as"));
  refuse_overwriting_inputs({folder / "new.exr", folder / "other.exr"}, {});
}

}  // namespace
}  // namespace hemibake
