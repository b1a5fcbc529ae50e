// Files read as a whole.
#pragma once

#include <filesystem>
#include <string>

namespace hemibake {

// Returns all bytes. Throws InputError naming the file where it is a folder or cannot be read.
std::string read_whole_file(const std::filesystem::path& path);

}  // namespace hemibake
