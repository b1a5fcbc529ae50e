// A temporary file that stands in for memory: blocks of links are written to it once and read where they are
// mapped.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <span>

namespace hemibake {

class SpillFile {
 public:
  // Makes the file in `folder` (empty: the current one), without a name: whatever ends the process leaves
  // nothing. Throws InputError where that cannot be done.
  explicit SpillFile(const std::filesystem::path& folder);
  ~SpillFile();
  SpillFile(const SpillFile&) = delete;
  SpillFile& operator=(const SpillFile&) = delete;

  // Writes the parts one after another and returns where the first now lies in memory, aligned for any
  // number. Any thread. Throws InputError where the disk is full.
  const std::byte* store(std::initializer_list<std::span<const std::byte>> parts);

  // Says that these bytes, and those near them, are not needed for the time being; reading them again is
  // slower but right.
  static void release(const std::byte* bytes, size_t size);

 private:
  std::filesystem::path folder_;
  int descriptor_ = -1;
  std::byte* map_ = nullptr;
  std::atomic<size_t> size_{0};
};

}  // namespace hemibake
