// Signals as a request to stop: long work asks for it between pieces and unwinds, so that temporary files go.
#pragma once

#include <atomic>

namespace hemibake {

// Makes SIGINT, SIGTERM and SIGHUP set the returned flag instead of killing the process; a second one kills,
// and what the caller ignores, as `nohup` does, stays ignored. SIGXFSZ and SIGPIPE are ignored: a failed
// write comes back as an error of that write.
const std::atomic<bool>& install_signal_handlers();

}  // namespace hemibake
