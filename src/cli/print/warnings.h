// Prints what a person should know although the work went well.
#pragma once

#include <string>
#include <vector>

namespace hemibake {

// Prints one line a warning on standard error, each about `what`.
void print_warnings(const std::string& what, const std::vector<std::string>& warnings);

}  // namespace hemibake
