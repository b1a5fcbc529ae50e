#include "cli/signals.h"

#include <array>
#include <csignal>

namespace hemibake {
namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may set it");

constexpr std::array kRequests = {SIGINT, SIGTERM, SIGHUP};

void set_handler(int signal, void (*handler)(int)) {
  struct sigaction action {};
  // Without SA_RESTART: waiting for a pipe ends.
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

bool is_ignored(int signal) {
  struct sigaction action {};
  return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

void on_signal(int) {
  // For work that does not come back to ask: the next one kills.
  for (const int signal : kRequests)
    if (!is_ignored(signal)) set_handler(signal, SIG_DFL);
  interrupted = true;
}

}  // namespace

const std::atomic<bool>& install_signal_handlers() {
  for (const int signal : kRequests)
    if (!is_ignored(signal)) set_handler(signal, on_signal);
  for (const int signal : {SIGXFSZ, SIGPIPE}) set_handler(signal, SIG_IGN);
  return interrupted;
}

}  // namespace hemibake
