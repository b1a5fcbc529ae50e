#include "cli/print/streams.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "core/error.h"
#include "core/printable.h"

namespace hemibake {
namespace {

// Returns 0, or the errno of a write that failed.
int write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(descriptor, bytes.data(), bytes.size());
    if (written >= 0) {
      bytes.remove_prefix(static_cast<size_t>(written));
    } else if (errno == EAGAIN) {
      // Another program made the stream non-blocking.
      pollfd wait_for{descriptor, POLLOUT, 0};
      if (poll(&wait_for, 1, -1) < 0 && errno != EINTR) return errno;
    } else if (errno != EINTR) {
      return errno;
    }
  }
  return 0;
}

}  // namespace

void open_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(stream, F_GETFD) != -1) continue;
    // The lowest number is free, and open() takes it. Standard output is for reading: a result must not
    // vanish.
    static_cast<void>(open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY));
  }
}

void print_result(std::string_view text) {
  if (const int error = write_all(STDOUT_FILENO, printable_text(text)))
    throw InputError(fmt::format("standard output: could not write: {}, expected one that takes the result",
                                 std::strerror(error)));
}

void write_to_standard_error(std::string_view bytes) { static_cast<void>(write_all(STDERR_FILENO, bytes)); }

void print_message(std::string_view message) {
  write_to_standard_error(fmt::format("hemibake: {}\n", printable_line(message)));
}

}  // namespace hemibake
