#include "io/input_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "core/context.h"
#include "core/error.h"

namespace hemibake {

namespace fs = std::filesystem;

std::string read_whole_file(const fs::path& path, uint64_t most_bytes) {
  constexpr size_t kBlockBytes = size_t{1} << 24;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status))
    throw InputError(fmt::format("{}: is a folder, expected a file", path.string()));
  if (!fs::exists(status))
    throw InputError(fmt::format("{}: could not read: {}", path.string(), error.message()));
  if (!fs::is_regular_file(status))
    throw InputError(fmt::format("{}: is not a regular file, expected one", path.string()));
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!file) throw InputError(fmt::format("{}: could not read: {}", path.string(), std::strerror(errno)));
  const uint64_t size = fs::file_size(path, error);
  std::string bytes;
  if (!error && size <= most_bytes) bytes.reserve(size + 1);
  for (size_t count = 1; count > 0;) {
    throw_if_cancelled();
    const size_t begin = bytes.size();
    // One byte more than there should be finds the end.
    bytes.resize(begin + (begin <= size ? std::min(kBlockBytes, size + 1 - begin) : kBlockBytes));
    count = std::fread(bytes.data() + begin, 1, bytes.size() - begin, file.get());
    bytes.resize(begin + count);
    if (bytes.size() > most_bytes)
      throw InputError(fmt::format("{}: has {} bytes, expected at most {}", path.string(), size, most_bytes));
  }
  if (std::ferror(file.get()))
    throw InputError(fmt::format("{}: could not read: {}", path.string(), std::strerror(errno)));
  return bytes;
}

}  // namespace hemibake
