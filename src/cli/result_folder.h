// Makes the folder that a command puts several results in.
#pragma once

#include <fmt/format.h>

#include <filesystem>

#include "core/error.h"

namespace hemibake {

// The folder of the results, which may be new; its parent may not. A new one goes again where nothing came of
// it.
class ResultFolder {
 public:
  explicit ResultFolder(const std::filesystem::path& path) : path_(path) {
    std::error_code error;
    made_ = std::filesystem::create_directory(path, error);
    if (error || !std::filesystem::is_directory(path, error))
      throw InputError(
          fmt::format("{}: could not make the folder: {}, expected a folder or a new name in one",
                      path.string(), error ? error.message() : "a file of that name is there"));
  }
  ~ResultFolder() {
    std::error_code not_empty;
    if (made_) std::filesystem::remove(path_, not_empty);
  }
  ResultFolder(const ResultFolder&) = delete;
  ResultFolder& operator=(const ResultFolder&) = delete;

 private:
  std::filesystem::path path_;
  bool made_ = false;
};

}  // namespace hemibake
