#include "cli/print/warnings.h"

#include <fmt/format.h>

#include <cstdio>

namespace hemibake {

void print_warnings(const std::string& what, const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings)
    fmt::print(stderr, "hemibake: {}: warning: {}\n", what, warning);
}

}  // namespace hemibake
