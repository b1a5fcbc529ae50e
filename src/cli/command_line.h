// The command line as a result records it.
#pragma once

#include <span>
#include <string>

namespace hemibake {

// Returns one line that makes the same result again in a POSIX shell: "hemibake bake 'my map.png' --rays 64".
// Leaves out all that changes no byte of a result: --threads N, --json, -o / --output FILE, and the folder of
// the program. arguments: of main, the program's name first.
std::string command_line(std::span<const std::string> arguments);

// Stores the arguments of main for this_command_line(). To be called once, first.
void set_command_line(int argc, const char* const* argv);

// Returns command_line() of this process.
const std::string& this_command_line();

}  // namespace hemibake
