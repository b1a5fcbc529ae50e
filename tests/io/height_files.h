// What the tests of height files share.
#pragma once

#include <cstring>
#include <string>
#include <vector>

#include "io/foreign_images.h"
#include "io/height_file.h"

namespace hemibake {

class HeightFiles : public ImageIo {
 protected:
  HeightFile read(const std::string& name, const HeightFileOptions& options = {}) {
    return read_height_file(folder_ / name, options);
  }
  std::string fault(const std::string& name, const HeightFileOptions& options = {}) {
    return error_of<InputError>([&] { read(name, options); });
  }
};

inline HeightFileOptions part(int number) {
  HeightFileOptions options;
  options.part = number;
  return options;
}

inline HeightFileOptions raw(const std::string& layout) {
  HeightFileOptions options;
  options.raw = layout;
  return options;
}

inline HeightFileOptions no_data(double value) {
  HeightFileOptions options;
  options.no_data = value;
  return options;
}

// The bytes of numbers in either order.
template <class T>
std::string bytes_of(const std::vector<T>& values, bool is_big_endian = false) {
  std::string bytes;
  for (const T& value : values) {
    std::string one(sizeof(T), '\0');
    std::memcpy(one.data(), &value, sizeof(T));
    bytes += is_big_endian ? std::string(one.rbegin(), one.rend()) : one;
  }
  return bytes;
}

}  // namespace hemibake
