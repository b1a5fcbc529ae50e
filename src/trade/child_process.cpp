#include "trade/child_process.h"

#include <fmt/format.h>
#include <malloc.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <new>
#include <stdexcept>

#include "core/context.h"
#include "core/error.h"

namespace hemibake {
namespace {

// First byte of what a child sends back.
enum Outcome : char { kDone = 'd', kInput = 'i', kCheck = 'c', kInterrupted = 'x', kBug = 'b' };

std::string tagged(Outcome outcome, const std::string& text) { return std::string(1, outcome) + text; }

std::string answer_of(const std::function<std::string()>& work) {
  try {
    return tagged(kDone, work());
  } catch (const InputError& error) {
    return tagged(kInput, error.what());
  } catch (const CheckError& error) {
    return tagged(kCheck, error.what());
  } catch (const Cancelled&) {
    return tagged(kInterrupted, "");
  } catch (const std::bad_alloc&) {
    return tagged(kInput, "out of memory, expected a smaller map");
  } catch (const std::exception& error) {
    return tagged(kBug, error.what());
  } catch (...) {
    return tagged(kBug, "an exception of an unknown type");
  }
}

[[noreturn]] void be_the_child(int pipe_end, pid_t parent, const std::function<std::string()>& work) {
  // Ctrl-C goes to the parent's group only, and from there here, once: a second signal would kill. Without a
  // parent there is no use in going on.
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(1);
  const std::string answer = answer_of(work);
  size_t sent = 0;
  while (sent < answer.size()) {
    const ssize_t n = write(pipe_end, answer.data() + sent, answer.size() - sent);
    if (n < 0 && errno != EINTR) break;
    if (n > 0) sent += static_cast<size_t>(n);
  }
  // No destructor of the parent's objects, no flush of its buffers.
  _exit(sent == answer.size() ? 0 : 1);
}

// Everything the child sends until it closes its end. An interrupt here is passed on to it.
std::string read_all(int pipe_end, pid_t child) {
  std::string text;
  bool told = false;
  char buffer[4096];
  while (true) {
    if (cancel_requested() && !told) {
      kill(child, SIGTERM);
      told = true;
    }
    pollfd wait_for{pipe_end, POLLIN, 0};
    // A signal ends the wait; the timeout is for one that came just before it.
    if (poll(&wait_for, 1, 100) <= 0) continue;
    const ssize_t n = read(pipe_end, buffer, sizeof buffer);
    if (n == 0) return text;
    if (n > 0) text.append(buffer, static_cast<size_t>(n));
    if (n < 0 && errno != EINTR) return text;
  }
}

// status: of waitpid.
[[noreturn]] void fail_without_answer(const std::string& what, int status) {
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL)
    throw InputError(what + ": its process was killed, most likely out of memory, expected a smaller map");
  throw std::runtime_error(WIFSIGNALED(status)
                               ? fmt::format("{}: its process was ended by signal {}", what, WTERMSIG(status))
                               : fmt::format("{}: its process ended without an answer", what));
}

size_t status_bytes(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(name + ":")) return std::stoul(line.substr(name.size() + 1)) * 1024;
  throw std::runtime_error("/proc/self/status: no " + name + ", expected the memory of this process");
}

}  // namespace

std::string run_in_child(const std::string& what, const std::function<std::string()>& work) {
  throw_if_cancelled();
  int ends[2];
  if (pipe(ends) != 0)
    throw InputError(
        fmt::format("{}: no pipe: {}, expected more open files allowed", what, std::strerror(errno)));
  std::fflush(nullptr);
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0) {
    const int reason = errno;
    close(ends[0]);
    close(ends[1]);
    throw InputError(
        fmt::format("{}: no new process: {}, expected one more to be allowed", what, std::strerror(reason)));
  }
  if (child == 0) {
    close(ends[0]);
    be_the_child(ends[1], parent, work);
  }
  close(ends[1]);
  const std::string answer = read_all(ends[0], child);
  close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  throw_if_cancelled();
  if (answer.empty() || !WIFEXITED(status)) fail_without_answer(what, status);
  const std::string text = answer.substr(1);
  switch (answer[0]) {
    case kDone:
      return text;
    case kInput:
      throw InputError(text);
    case kCheck:
      throw CheckError(text);
    case kInterrupted:
      throw Cancelled();
    default:
      throw std::runtime_error(what + ": " + text);
  }
}

MemoryProbe::MemoryProbe() {
  malloc_trim(0);
  // 5 sets the high-water mark back to what is resident now (proc(5)); where it may not be written, the mark
  // of the process so far stays.
  std::ofstream("/proc/self/clear_refs") << 5;
  at_start_bytes_ = status_bytes("VmRSS");
}

size_t MemoryProbe::peak_growth_bytes() const {
  return std::max(status_bytes("VmHWM"), at_start_bytes_) - at_start_bytes_;
}

}  // namespace hemibake
