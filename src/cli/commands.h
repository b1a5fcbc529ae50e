// The whole program: parses, runs, and turns an error into one line and an exit code.
#pragma once

#include <span>

#include "cli/options/command.h"

namespace hemibake {

// Returns every command, in the order of the help.
std::span<const Command> commands();

// Returns the exit code: 0 done, 1 a check or fit failed, 2 bad input or usage, 130 interrupted.
int run_command_line(int argc, char** argv);

}  // namespace hemibake
