// Signals as a request to stop: long work asks for it between pieces and unwinds, so that temporary files go.
#pragma once

#include <atomic>

namespace hemibake {

// Makes SIGINT and SIGTERM set the returned flag instead of killing the process; a second one kills. SIGXFSZ
// and SIGPIPE are ignored, so that a failed write comes back as an error of that write.
const std::atomic<bool>& install_signal_handlers();

}  // namespace hemibake
