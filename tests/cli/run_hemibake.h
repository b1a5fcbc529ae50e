// Runs the real binary, for tests of the command line.
#pragma once

#include <filesystem>
#include <string>

namespace hemibake {

// A folder of its own that goes with the object.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

struct CommandResult {
  int exit_code;
  std::string standard_output;
  std::string standard_error;
};

// arguments: as typed in a shell after the program's name. A signal counts as exit code 128 + its number.
CommandResult run_hemibake(const std::string& arguments);

}  // namespace hemibake
