// Files read as a whole.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace hemibake {

// Returns all bytes. Throws InputError naming the file where it is a folder or no regular file (a pipe may
// never end), has more than `most_bytes`, or cannot be read.
std::string read_whole_file(const std::filesystem::path& path, uint64_t most_bytes = UINT64_MAX);

}  // namespace hemibake
