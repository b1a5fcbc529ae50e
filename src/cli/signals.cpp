#include "cli/signals.h"

#include <csignal>

namespace hemibake {
namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may set it");

void on_signal(int signal) {
  // For work that does not come back to ask.
  std::signal(signal, SIG_DFL);
  interrupted = true;
}

}  // namespace

const std::atomic<bool>& install_signal_handlers() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  return interrupted;
}

}  // namespace hemibake
