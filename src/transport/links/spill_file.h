// A temporary file in place of memory: blocks of form factors are written to it once and read where they are
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
  // Makes the file without a name: whatever ends the process leaves nothing. Throws InputError if that fails.
  // folder: where; empty: the current one.
  explicit SpillFile(const std::filesystem::path& folder);
  ~SpillFile();
  SpillFile(const SpillFile&) = delete;
  SpillFile& operator=(const SpillFile&) = delete;

  // Writes the parts one after another and returns where the first is mapped, aligned to 64 bytes. Any thread
  // may call it. Throws InputError if the disk is full.
  const std::byte* store(std::initializer_list<std::span<const std::byte>> parts);

  // Gives the memory of stored bytes, and of those near them, back. Reading them again is slower but right.
  static void release(const std::byte* bytes, size_t size);

 private:
  std::filesystem::path folder_;
  int descriptor_ = -1;
  std::byte* map_ = nullptr;
  std::atomic<size_t> size_{0};
};

}  // namespace hemibake
