#include "core/temporary_file.h"

#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "io/io_testing.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

TEST(TemporaryFile, OfAKilledProcessGoesWithTheNext) {
  const TemporaryFolder folder;
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    make_temporary_file(folder.path(), 0666);
    make_temporary_file(folder.path(), 0666);
    static_cast<void>(write(ends[1], "x", 1));
    pause();
    _exit(0);
  }
  char made = 0;
  ASSERT_EQ(read(ends[0], &made, 1), 1);
  EXPECT_EQ(folder.count(), 2u);
  remove_stale_temporary_files(folder.path());
  EXPECT_EQ(folder.count(), 2u) << "their process lives";
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_EQ(folder.count(), 2u);
  const TemporaryFile next = make_temporary_file(folder.path(), 0666);
  EXPECT_GE(next.descriptor, 0);
  EXPECT_EQ(folder.count(), 1u);
  EXPECT_TRUE(fs::exists(next.path));
  for (const int descriptor : {ends[0], ends[1], next.descriptor}) close(descriptor);
}

TEST(TemporaryFile, LeavesFilesOfOtherNamesAndKinds) {
  const TemporaryFolder folder;
  write_bytes(folder / "precious", "x");
  for (const char* name : {".hemibake-", ".hemibake-0123456789abcde", ".hemibake-0123456789abcdef0",
                           ".hemibake-0123456789abcdeg", "hemibake-0123456789abcdef", ".out.1-0.exr"})
    write_bytes(folder / name, "x");
  fs::create_symlink("precious", folder / ".hemibake-0000000000000000");
  fs::create_directory(folder / ".hemibake-0000000000000001");
  remove_stale_temporary_files(folder.path());
  EXPECT_EQ(folder.count(), 9u);
  write_bytes(folder / ".hemibake-0123456789abcdef", "x");
  remove_stale_temporary_files(folder.path());
  EXPECT_EQ(folder.count(), 9u);
  remove_stale_temporary_files(folder / "missing");
}

TEST(TemporaryFile, NamelessLeavesNoName) {
  const TemporaryFolder folder;
  const int descriptor = make_nameless_file(folder.path());
  ASSERT_GE(descriptor, 0);
  EXPECT_EQ(write(descriptor, "x", 1), 1);
  EXPECT_EQ(folder.count(), 0u);
  close(descriptor);
  EXPECT_EQ(make_nameless_file(folder / "missing"), -1);
  EXPECT_EQ(errno, ENOENT);
}

}  // namespace
}  // namespace hemibake
