#include "io/input_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core/context.h"
#include "core/error.h"
#include "core/memory_limit.h"
#include "io/file_context.h"

namespace hemibake {
namespace {

constexpr size_t kBlockBytes = size_t{1} << 20;
// Of a pipe, which may never end.
constexpr size_t kMostPipeBytes = size_t{1} << 30;
constexpr int kWaitMs = 100;

class Descriptor {
 public:
  explicit Descriptor(const std::filesystem::path& path)
      : number_(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const { return number_; }

 private:
  int number_;
};

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& fault) {
  throw InputError(fmt::format("{}: {}", path.string(), fault));
}

[[noreturn]] void refuse_reading(const std::filesystem::path& path) {
  refuse(path, fmt::format("could not read: {}", std::strerror(errno)));
}

// Waits for the other side of a pipe, unless the caller wants to stop.
void wait_for_bytes(int descriptor) {
  pollfd waiting{descriptor, POLLIN, 0};
  do throw_if_cancelled();
  while (poll(&waiting, 1, kWaitMs) <= 0);
}

}  // namespace

std::string read_whole_file(const std::filesystem::path& path) {
  struct stat status;
  if (stat(path.c_str(), &status) != 0) refuse_reading(path);
  if (S_ISDIR(status.st_mode)) refuse(path, "is a folder, expected a file");
  const bool is_pipe = S_ISFIFO(status.st_mode);
  if (!is_pipe && !S_ISREG(status.st_mode)) refuse(path, "is a device or socket, expected a file");
  if (!is_pipe)
    with_file_context(path, [&] {
      require_memory(static_cast<double>(status.st_size), fmt::format("{} bytes", status.st_size));
    });
  const Descriptor file(path);
  if (file.number() < 0) refuse_reading(path);
  std::string bytes;
  for (size_t size = 0;;) {
    throw_if_cancelled();
    if (is_pipe) wait_for_bytes(file.number());
    const size_t expected = is_pipe ? 0 : static_cast<size_t>(status.st_size);
    bytes.resize(std::max(expected, size) + (size < expected ? 0 : kBlockBytes));
    const ssize_t count = read(file.number(), &bytes[size], std::min(kBlockBytes, bytes.size() - size));
    if (count < 0 && errno != EAGAIN && errno != EINTR) refuse_reading(path);
    if (count > 0) size += static_cast<size_t>(count);
    if (is_pipe && size > kMostPipeBytes) refuse(path, "is a pipe without an end, expected at most 1 GiB");
    bytes.resize(count == 0 ? size : std::max(expected, size));
    if (count == 0) return bytes;
  }
}

}  // namespace hemibake
