// Files under names of no meaning, for what is not whole yet. A lock tells those of running processes from
// those that a killed one left, in containers too, where process numbers repeat.
#pragma once

#include <sys/types.h>

#include <filesystem>

namespace hemibake {

// A new, empty file that this process holds: open, named ".hemibake-" and 16 hex digits, and locked by
// flock().
struct TemporaryFile {
  std::filesystem::path path;
  int descriptor = -1;  // for reading and writing; -1: could not be made, errno says why
};

// Makes a temporary file in `folder` (empty: the current one); removes those there that no process holds.
// mode: of open(), before the process' umask.
TemporaryFile make_temporary_file(const std::filesystem::path& folder, mode_t mode);

// Removes the temporary files of `folder` that no process holds. Errors are left for the next time.
void remove_stale_temporary_files(const std::filesystem::path& folder);

// Returns the descriptor of a temporary file without a name, which goes with the process; -1 and errno where
// none can be made in `folder` (empty: the current one).
int make_nameless_file(const std::filesystem::path& folder);

}  // namespace hemibake
