// Ctrl-C and SIGTERM set a flag; long work asks for it between pieces and unwinds, so that temporary files
// go.
#pragma once

namespace hemibake {

// From now on SIGINT and SIGTERM set the flag instead of killing the process; SIGXFSZ and SIGPIPE are ignored
// so that a failed write comes back as an error of that write.
void install_signal_handlers();

bool interrupt_requested();

// Throws Interrupted where a signal has come.
void throw_if_interrupted();

}  // namespace hemibake
