#include "transport/links/spill_file.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string>

#include "core/error.h"
#include "core/temporary_file.h"

namespace hemibake {
namespace {

// Addresses reserved for the file, more than any disk holds: they cost nothing and keep the file in one
// piece.
constexpr size_t kMostBytes = size_t{1} << 44;
constexpr size_t kAlignment = 64;
// Reading a page maps its neighbours of the same 64 KiB too (Linux, "fault around"): they are released
// together.
constexpr uintptr_t kMappedTogether = uintptr_t{64} << 10;

[[noreturn]] void fail(const std::filesystem::path& folder, const char* what) {
  throw InputError(
      fmt::format("{}: could not {} a temporary file for links: {}, expected more disk space, or "
                  "more memory allowed",
                  folder.string(), what, std::strerror(errno)));
}

}  // namespace

SpillFile::SpillFile(const std::filesystem::path& folder) : folder_(folder.empty() ? "." : folder) {
  descriptor_ = make_nameless_file(folder_);
  if (descriptor_ < 0) fail(folder_, "make");
  void* map = mmap(nullptr, kMostBytes, PROT_READ, MAP_SHARED | MAP_NORESERVE, descriptor_, 0);
  if (map == MAP_FAILED) {
    close(descriptor_);
    fail(folder_, "map");
  }
  map_ = static_cast<std::byte*>(map);
}

SpillFile::~SpillFile() {
  munmap(map_, kMostBytes);
  close(descriptor_);
}

const std::byte* SpillFile::store(std::initializer_list<std::span<const std::byte>> parts) {
  size_t total = 0;
  for (const auto& part : parts) total += part.size();
  const size_t begin = size_.fetch_add((total + kAlignment - 1) / kAlignment * kAlignment);
  size_t at = begin;
  for (std::span<const std::byte> part : parts) {
    while (!part.empty()) {
      const ssize_t written = pwrite(descriptor_, part.data(), part.size(), static_cast<off_t>(at));
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail(folder_, "write");
      part = part.subspan(static_cast<size_t>(written));
      at += static_cast<size_t>(written);
    }
  }
  return map_ + begin;
}

void SpillFile::release(const std::byte* bytes, size_t size) {
  const uintptr_t begin = reinterpret_cast<uintptr_t>(bytes) / kMappedTogether * kMappedTogether;
  const uintptr_t last = reinterpret_cast<uintptr_t>(bytes) + size;
  const uintptr_t end = (last + kMappedTogether - 1) / kMappedTogether * kMappedTogether;
  madvise(reinterpret_cast<void*>(begin), end - begin, MADV_DONTNEED);
}

}  // namespace hemibake
