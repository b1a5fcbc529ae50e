// A file that appears under its name only when it is whole: written under a temporary name in the same
// folder, renamed by commit(). Whatever ends the writing early (an error, Ctrl-C) leaves nothing behind.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string_view>

namespace hemibake {

class OutputFile {
 public:
  // Creates the temporary file, empty. A symbolic link is followed: its target is what gets replaced. Throws
  // InputError where the folder is missing or unwritable, or the path is there and is not a writable regular
  // file.
  explicit OutputFile(const std::filesystem::path& path);
  // Removes the temporary file unless it was committed.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  // In the same folder, with the same extension, of no other process.
  const std::filesystem::path& temporary_path() const { return temporary_path_; }
  // The temporary file, open for reading and writing at offset 0; closed by this object.
  int descriptor() const { return descriptor_; }

  // Appends. Throws InputError where not everything could be written.
  void write(std::string_view bytes);
  // Flushes to the disk, checks and renames. To be called once; throws InputError where the disk is full.
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path target_;
  std::filesystem::path temporary_path_;
  int descriptor_ = -1;
  bool committed_ = false;
};

// Fails before any work is done: throws InputError where `path` does not end in one of `suffixes` (".exr", in
// any case; none given: any) or where an OutputFile of that path could not be created. Leaves nothing behind.
void check_output_path(const std::filesystem::path& path,
                       std::initializer_list<std::string_view> suffixes = {});

// Throws InputError "FILE: could not write: REASON" for an errno value.
[[noreturn]] void fail_write(const std::filesystem::path& path, int error_number);

// The extension in lower case, with its dot: ".exr".
std::string lower_case_extension(const std::filesystem::path& path);

}  // namespace hemibake
