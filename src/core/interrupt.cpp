#include "core/interrupt.h"

#include <csignal>

#include "core/error.h"

namespace hemibake {
namespace {

volatile std::sig_atomic_t interrupted = 0;

void on_signal(int signal) {
  // A second Ctrl-C kills at once: for work that does not come back to ask.
  std::signal(signal, SIG_DFL);
  interrupted = 1;
}

}  // namespace

void install_signal_handlers() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
}

bool interrupt_requested() { return interrupted != 0; }

void throw_if_interrupted() {
  if (interrupt_requested()) throw Interrupted();
}

}  // namespace hemibake
