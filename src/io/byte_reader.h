// Reads integers out of the header of a file.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>

namespace hemibake {

class ByteReader {
 public:
  explicit ByteReader(const std::filesystem::path& path) : file_(path, std::ios::binary) {}

  std::endian order = std::endian::little;

  // Returns the unsigned integer of 1 to 8 bytes at an offset; 0 where the file ends before.
  uint64_t at(uint64_t offset, int bytes) {
    std::array<unsigned char, 8> raw{};
    file_.clear();
    file_.seekg(static_cast<std::streamoff>(offset));
    if (!file_.read(reinterpret_cast<char*>(raw.data()), bytes)) return 0;
    uint64_t value = 0;
    for (int i = 0; i < bytes; ++i)
      value = value << 8 | raw[static_cast<size_t>(order == std::endian::big ? i : bytes - 1 - i)];
    return value;
  }

 private:
  std::ifstream file_;
};

}  // namespace hemibake
