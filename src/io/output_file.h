// Files that appear under their name only when whole: written under a temporary name in the same folder,
// renamed by commit(). Errors and Ctrl-C leave nothing behind; what a killed process left, the next that
// writes into the folder removes.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <memory>
#include <string_view>
#include <vector>

namespace hemibake {

class OutputFile {
 public:
  // Creates the temporary file, empty. Follows a symbolic link: replaces its target, or makes it. Keeps the
  // permissions of a file that it replaces; other hard links to that keep the old file. Throws InputError
  // where the folder is missing or unwritable, or the path is there and is not a writable regular file.
  explicit OutputFile(const std::filesystem::path& path);
  // Removes the temporary file unless it was committed.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  // Same folder, of no other process (core/temporary_file.h).
  const std::filesystem::path& temporary_path() const { return temporary_path_; }
  // The temporary file, open for reading and writing at offset 0, until this object goes.
  int descriptor() const { return descriptor_; }

  // Appends. Throws InputError where not everything could be written.
  void write(std::string_view bytes);
  // Flushes to the disk: commit() can then only fail to rename. Throws InputError where the disk is full.
  void finish();
  // Finishes, where that was not done yet, and renames. To be called once; throws InputError.
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path target_;
  std::filesystem::path temporary_path_;
  int descriptor_ = -1;
  bool finished_ = false;
  bool committed_ = false;
};

// Files that belong together. All are whole under temporary names before the first gets its own.
class OutputSet {
 public:
  // Creates a file of the set, as OutputFile does. Files get their names in the order they were added.
  OutputFile& add(const std::filesystem::path& path);
  std::vector<std::filesystem::path> paths() const;
  // Finishes all files and renames them. To be called once; throws InputError.
  void commit();

 private:
  std::vector<std::unique_ptr<OutputFile>> files_;
};

// Writes `text` as the whole file. Throws InputError as OutputFile does.
void write_text_file(const std::filesystem::path& path, std::string_view text);

// Checks before any work is done that an OutputFile of that path can be created; leaves nothing behind.
// Throws InputError where it cannot, or where `path` does not end in one of `suffixes`.
// suffixes: as ".exr", matched in any case; none given: any.
void check_output_path(const std::filesystem::path& path,
                       std::initializer_list<std::string_view> suffixes = {});

// Throws InputError "FILE: could not write: REASON" for an errno value.
[[noreturn]] void fail_write(const std::filesystem::path& path, int error_number);

// Returns the file that writing to a path replaces or makes: the path itself, or what symbolic links lead to.
// Throws InputError where they lead in a circle.
std::filesystem::path resolve_target(const std::filesystem::path& path);

// Returns the extension in lower case, with its dot: ".exr".
std::string lower_case_extension(const std::filesystem::path& path);

}  // namespace hemibake
