// How much memory reading may take: by what the caller allows, else by the machine.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace hemibake {

// Memory of this machine, bytes.
size_t machine_memory_bytes();

// Returns the bytes, beside the program's own, that work on a map needs at least. width, height: texels.
using MapNeed = std::function<double(int width, int height)>;

// Puts a limit in force for the calling thread until the scope ends.
class MemoryScope {
 public:
  // gib: of the whole program, GiB, above 0; absent: what the machine has.
  // need: of what is done with a map, so that one too large is refused by its header; empty: none.
  explicit MemoryScope(std::optional<double> gib, MapNeed need = {});
  ~MemoryScope();
  MemoryScope(const MemoryScope&) = delete;
  MemoryScope& operator=(const MemoryScope&) = delete;

 private:
  std::optional<double> outer_gib_;
  MapNeed outer_need_;
};

// Says that memory is short: "0.62 GiB, expected at most the 0.5 GiB of {memory}: …", for a SettingError.
// needed_bytes: of the whole program, above what is allowed. allowed_gib: absent: what the machine has.
std::string memory_fault(double needed_bytes, std::optional<double> allowed_gib);

// Throws SettingError, without a file's name, where data need more than the limit in force leaves them.
// bytes: of the data; what: they are of, for the message: "4096 x 4096 texels".
void require_memory(double bytes, const std::string& what);

// Throws SettingError, without a file's name, where a map needs more, to be read or by the need in force.
// width, height: texels; bytes: that reading it takes.
void require_map_memory(int width, int height, double bytes);

// Returns the bytes that the limit in force leaves to data beside the program itself, at least 0.
double memory_for_data();

}  // namespace hemibake
