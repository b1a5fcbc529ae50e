// Files read as a whole.
#pragma once

#include <filesystem>
#include <string>

namespace hemibake {

// Returns all bytes of a file or pipe; waiting for a pipe ends when the caller cancels. Throws InputError
// naming the file where it is a folder, a device or a socket, a pipe of over 1 GiB, or cannot be read.
std::string read_whole_file(const std::filesystem::path& path);

}  // namespace hemibake
