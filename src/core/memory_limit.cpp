#include "core/memory_limit.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "core/error.h"

namespace hemibake {
namespace {

constexpr double kGib = 1024.0 * 1024 * 1024;
// The program with its libraries, before it has read anything (measured).
constexpr double kProgramBytes = 150.0 * 1024 * 1024;

thread_local double allowed_bytes = 0;  // 0: what the machine has

}  // namespace

size_t machine_memory_bytes() {
  return static_cast<size_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<size_t>(sysconf(_SC_PAGE_SIZE));
}

MemoryScope::MemoryScope(std::optional<double> gib) : outer_bytes_(allowed_bytes) {
  allowed_bytes = gib ? *gib * kGib : 0;
}

MemoryScope::~MemoryScope() { allowed_bytes = outer_bytes_; }

double memory_for_data() {
  const double allowed = allowed_bytes > 0 ? allowed_bytes : static_cast<double>(machine_memory_bytes());
  return std::max(0.0, allowed - kProgramBytes);
}

void require_memory(double bytes, const std::string& what) {
  if (bytes <= memory_for_data()) return;
  throw InputError(fmt::format("has {}, which need {:.2f} GiB to be read, expected at most {:.2f} GiB of {}",
                               what, (bytes + kProgramBytes) / kGib,
                               (memory_for_data() + kProgramBytes) / kGib,
                               allowed_bytes > 0 ? "the memory allowed" : "this machine"));
}

}  // namespace hemibake
