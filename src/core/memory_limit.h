// How much memory reading may take: by what the caller allows, else by the machine.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace hemibake {

// Memory of this machine, bytes.
size_t machine_memory_bytes();

// Puts a limit in force for the calling thread until the scope ends.
class MemoryScope {
 public:
  // gib: of the whole program, GiB, above 0; absent: what the machine has.
  explicit MemoryScope(std::optional<double> gib);
  ~MemoryScope();
  MemoryScope(const MemoryScope&) = delete;
  MemoryScope& operator=(const MemoryScope&) = delete;

 private:
  double outer_bytes_;
};

// Throws InputError, without a file's name, where data need more than the limit in force leaves them.
// bytes: of the data; what: they are of, for the message: "4096 x 4096 texels".
void require_memory(double bytes, const std::string& what);

// Returns the bytes that the limit in force leaves to data beside the program itself, at least 0.
double memory_for_data();

}  // namespace hemibake
