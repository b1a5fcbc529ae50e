// Prints what a person should know although the work went well.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hemibake {

// Prints "hemibake: MESSAGE" on standard error as one line, whatever a file name or a library puts into it.
void print_error(std::string message);

// Prints one line a warning on standard error, each about `what`.
void print_warnings(const std::string& what, const std::vector<std::string>& warnings);

}  // namespace hemibake
