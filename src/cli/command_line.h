// The command line as a result records it.
#pragma once

#include <string>
#include <vector>

namespace hemibake {

// Returns one line that makes the same result again in a POSIX shell: "hemibake bake 'my map.png' --rays 64".
// Leaves out all that changes no byte of a result: --threads N, --json, -o / --output FILE, and the folder of
// the program. arguments: of main, the program's name first.
std::string command_line(const std::vector<std::string>& arguments);

}  // namespace hemibake
