#include "core/memory_limit.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"

namespace hemibake {
namespace {

constexpr double kGib = 1024.0 * 1024 * 1024;
// The program with its libraries, before it has read anything (measured).
constexpr double kProgramBytes = 150.0 * 1024 * 1024;

thread_local std::optional<double> allowed_gib;  // absent: what the machine has
thread_local MapNeed map_need;

}  // namespace

size_t machine_memory_bytes() {
  return static_cast<size_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<size_t>(sysconf(_SC_PAGE_SIZE));
}

MemoryScope::MemoryScope(std::optional<double> gib, MapNeed need)
    : outer_gib_(std::exchange(allowed_gib, gib)), outer_need_(std::exchange(map_need, std::move(need))) {}

MemoryScope::~MemoryScope() {
  allowed_gib = outer_gib_;
  map_need = std::move(outer_need_);
}

double memory_for_data() {
  const double allowed = allowed_gib ? *allowed_gib * kGib : static_cast<double>(machine_memory_bytes());
  return std::max(0.0, allowed - kProgramBytes);
}

std::string memory_fault(double needed_bytes, std::optional<double> allowed) {
  // Rounded apart: what is needed never looks like what is allowed.
  const double needed = std::ceil(needed_bytes / kGib * 100) / 100;
  if (allowed)
    return fmt::format(
        "{:.2f} GiB, expected at most the {} GiB of {{memory}}: allow more, or take smaller input", needed,
        *allowed);
  const double machine = std::floor(static_cast<double>(machine_memory_bytes()) / kGib * 100) / 100;
  return fmt::format("{:.2f} GiB, expected at most the {:.2f} GiB of this machine: take smaller input",
                     needed, machine);
}

void require_memory(double bytes, const std::string& what) {
  if (bytes <= memory_for_data()) return;
  throw SettingError(
      fmt::format("has {}, which need {}", what, memory_fault(bytes + kProgramBytes, allowed_gib)));
}

void require_map_memory(int width, int height, double bytes) {
  const double needed = map_need ? map_need(width, height) : 0;
  require_memory(std::max(bytes, needed), fmt::format("{} x {} texels", width, height));
}

}  // namespace hemibake
