#include "io/output_file.h"

#include <gmock/gmock.h>

#include "io/io_testing.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

TEST(OutputFile, AppearsOnlyWhenCommitted) {
  const TemporaryFolder folder;
  OutputFile file(folder / "out.exr");
  file.write("whole");
  EXPECT_FALSE(fs::exists(folder / "out.exr"));
  EXPECT_TRUE(fs::exists(file.temporary_path()));
  EXPECT_EQ(file.temporary_path().parent_path(), folder.path());
  file.commit();
  EXPECT_EQ(read_bytes(folder / "out.exr"), "whole");
  EXPECT_EQ(folder.count(), 1u);
}

TEST(OutputFile, ErrorAndInterruptLeaveWhatWasThere) {
  const TemporaryFolder folder;
  write_bytes(folder / "out.csv", "before");
  try {
    OutputFile file(folder / "out.csv");
    file.write("half");
    throw Cancelled();
  } catch (const Cancelled&) {
  }
  EXPECT_EQ(read_bytes(folder / "out.csv"), "before");
  EXPECT_EQ(folder.count(), 1u);
}

TEST(OutputFile, TwoOfOneNameDoNotMeet) {
  const TemporaryFolder folder;
  OutputFile a(folder / "out.csv"), b(folder / "out.csv");
  EXPECT_NE(a.temporary_path(), b.temporary_path());
}

TEST(OutputFile, NameWithoutFolderIsInTheWorkingFolder) {
  const TemporaryFolder folder;
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  OutputFile file("out.csv");
  file.write("1");
  file.commit();
  fs::current_path(before);
  EXPECT_EQ(read_bytes(folder / "out.csv"), "1");
}

TEST(OutputFile, FollowsASymbolicLink) {
  const TemporaryFolder folder;
  write_bytes(folder / "target.csv", "old");
  fs::create_symlink("target.csv", folder / "link.csv");
  OutputFile file(folder / "link.csv");
  file.write("new");
  file.commit();
  EXPECT_TRUE(fs::is_symlink(folder / "link.csv"));
  EXPECT_EQ(read_bytes(folder / "target.csv"), "new");
}

TEST(OutputFile, RefusesWhatCannotBeReplaced) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "folder.exr");
  const auto refusal = [](const fs::path& path) { return error_of<InputError>([&] { OutputFile{path}; }); };
  EXPECT_THAT(refusal(folder / "folder.exr"), HasSubstr("folder.exr: is a folder, expected"));
  EXPECT_THAT(refusal(folder / "missing/out.exr"),
              EndsWith("missing/out.exr: could not write: No such file or directory"));
  EXPECT_THAT(refusal("/dev/full"), StartsWith("/dev/full: is not a regular file, expected"));
  EXPECT_THAT(refusal(folder.path().string() + "/"), HasSubstr("expected the name of a file"));
  EXPECT_THAT(refusal(""), HasSubstr("expected the name of a file"));
  write_bytes(folder / "plain", "");
  EXPECT_THAT(refusal(folder / "plain/out.exr"), EndsWith("Not a directory"));
  EXPECT_EQ(folder.count(), 2u);
}

TEST(OutputFile, UnwritableFolder) {
  // /proc takes no files from anybody, root included.
  EXPECT_THAT(error_of<InputError>([] { OutputFile{"/proc/out.exr"}; }),
              StartsWith("/proc/out.exr: could not write: "));
}

TEST(OutputFile, CheckOutputPathLeavesNothing) {
  const TemporaryFolder folder;
  check_output_path(folder / "out.EXR", {".exr", ".png"});
  check_output_path(folder / "out", {});
  EXPECT_EQ(folder.count(), 0u);
  EXPECT_THAT(error_of<InputError>([&] {
                check_output_path(folder / "out.jpg", {".exr", ".png"});
              }),
              EndsWith("out.jpg: cannot write '.jpg' files, expected .exr or .png"));
  EXPECT_THAT(error_of<InputError>([&] { check_output_path(folder / "out", {".exr"}); }),
              EndsWith("out: cannot write '' files, expected .exr"));
}

TEST(OutputFile, KeepsThePermissionsOfWhatItReplaces) {
  const TemporaryFolder folder;
  write_bytes(folder / "out.csv", "old");
  for (const fs::perms mode : {fs::perms(0600), fs::perms(0664), fs::perms(0755)}) {
    fs::permissions(folder / "out.csv", mode);
    write_text_file(folder / "out.csv", "new");
    EXPECT_EQ(fs::status(folder / "out.csv").permissions(), mode);
  }
}

TEST(OutputFile, FollowsLinksToWhatIsNotThere) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "sub");
  fs::create_symlink("sub/second", folder / "first");
  fs::create_symlink("target", folder / "sub/second");
  write_text_file(folder / "first", "new");
  EXPECT_TRUE(fs::is_symlink(folder / "first"));
  EXPECT_EQ(read_bytes(folder / "sub/target"), "new");
  fs::create_symlink("circle", folder / "circle");
  EXPECT_THAT(error_of<InputError>([&] { OutputFile{folder / "circle"}; }), HasSubstr("could not write"));
}

TEST(OutputFile, NamesAsLongAsTheyMayBe) {
  const TemporaryFolder folder;
  const std::string name(255, 'x');
  write_text_file(folder / name, "whole");
  EXPECT_EQ(read_bytes(folder / name), "whole");
}

TEST(OutputFile, FullDiskIsOneLineAndLeavesNothing) {
  const SmallDisk disk;
  if (!disk.mounted()) GTEST_SKIP() << "may not mount a disk";
  const std::string text = error_of<InputError>([&] {
    OutputFile file(disk / "out.csv");
    file.write(std::string(1 << 20, 'x'));
    file.commit();
  });
  EXPECT_THAT(text, EndsWith("out.csv: could not write: No space left on device"));
  EXPECT_EQ(disk.count(), 0u);
}

}  // namespace
}  // namespace hemibake
