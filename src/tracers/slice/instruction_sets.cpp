#include "tracers/slice/instruction_sets.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <hwy/highway.h>

#include "core/error.h"

namespace hemibake {

std::vector<std::string> instruction_sets() {
  std::vector<std::string> names;
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) names.push_back(hwy::TargetName(target));
  return names;
}

void use_instruction_set(const std::string& name) {
  hwy::SetSupportedTargetsForTest(0);  // all again
  for (const int64_t target : hwy::SupportedAndGeneratedTargets())
    if (name == hwy::TargetName(target)) {
      hwy::SetSupportedTargetsForTest(target);
      return;
    }
  throw InputError(fmt::format("instruction set '{}': is none of this machine's, expected one of {}", name,
                               fmt::join(instruction_sets(), ", ")));
}

}  // namespace hemibake
