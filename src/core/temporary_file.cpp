#include "core/temporary_file.h"

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <ctime>
#include <memory>
#include <string>
#include <string_view>

namespace hemibake {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPrefix = ".hemibake-";
constexpr size_t kDigits = 16;
constexpr int kMostTries = 100;

fs::path folder_or_current(const fs::path& folder) { return folder.empty() ? "." : folder; }

bool is_temporary_name(std::string_view name) {
  return name.size() == kPrefix.size() + kDigits && name.starts_with(kPrefix) &&
         name.find_first_not_of("0123456789abcdef", kPrefix.size()) == std::string_view::npos;
}

std::string make_name() {
  uint64_t number = 0;
  if (getrandom(&number, sizeof number, GRND_NONBLOCK) != static_cast<ssize_t>(sizeof number)) {
    // Without the kernel's random numbers, names differ by time, process and count; O_EXCL finds those taken.
    static std::atomic<uint64_t> serial{0};
    timespec now{};
    clock_gettime(CLOCK_REALTIME, &now);
    number = static_cast<uint64_t>(now.tv_sec) * 1000000007 ^ static_cast<uint64_t>(now.tv_nsec) << 20 ^
             static_cast<uint64_t>(getpid()) << 44 ^ serial++;
  }
  return fmt::format("{}{:016x}", kPrefix, number);
}

// Returns whether a descriptor, which is locked, is still what the name stands for.
bool has_name(int descriptor, const fs::path& path) {
  struct stat opened {
  }, named{};
  return fstat(descriptor, &opened) == 0 && lstat(path.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

// Locks a new file. Where the file system has no locks, none can be removed as stale either. Returns false
// where another process took it for stale.
bool hold(int descriptor, const fs::path& path) {
  if (flock(descriptor, LOCK_EX | LOCK_NB) != 0) return errno != EWOULDBLOCK;
  return has_name(descriptor, path);
}

void remove_if_stale(const fs::path& path) {
  const int descriptor = open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (descriptor < 0) return;
  struct stat status {};
  if (fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) &&
      flock(descriptor, LOCK_EX | LOCK_NB) == 0 && has_name(descriptor, path))
    unlink(path.c_str());
  close(descriptor);
}

}  // namespace

void remove_stale_temporary_files(const fs::path& folder) {
  const fs::path at = folder_or_current(folder);
  const std::unique_ptr<DIR, int (*)(DIR*)> entries(opendir(at.c_str()), closedir);
  if (!entries) return;
  while (const dirent* entry = readdir(entries.get()))
    if (is_temporary_name(entry->d_name)) remove_if_stale(at / entry->d_name);
}

TemporaryFile make_temporary_file(const fs::path& folder, mode_t mode) {
  remove_stale_temporary_files(folder);
  for (int i = 0; i < kMostTries; ++i) {
    TemporaryFile file;
    file.path = folder / make_name();
    file.descriptor = open(file.path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (file.descriptor < 0 && errno == EEXIST) continue;
    if (file.descriptor < 0 || hold(file.descriptor, file.path)) return file;
    close(file.descriptor);
  }
  errno = EEXIST;
  return {};
}

int make_nameless_file(const fs::path& folder) {
  const fs::path at = folder_or_current(folder);
  const int descriptor = open(at.c_str(), O_RDWR | O_TMPFILE | O_EXCL | O_CLOEXEC, 0600);
  // Kernels say EISDIR and file systems EOPNOTSUPP where they have no nameless files.
  if (descriptor >= 0 || (errno != EISDIR && errno != EOPNOTSUPP)) return descriptor;
  const TemporaryFile file = make_temporary_file(folder, 0600);
  if (file.descriptor >= 0) unlink(file.path.c_str());
  return file.descriptor;
}

}  // namespace hemibake
