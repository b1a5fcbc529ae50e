#include "cli/print/warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace hemibake {

void print_error(std::string message) {
  std::ranges::replace_if(
      message, [](unsigned char c) { return c < ' '; }, ' ');
  fmt::print(stderr, "hemibake: {}\n", message);
}

void print_warnings(const std::string& what, const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings)
    fmt::print(stderr, "hemibake: {}: warning: {}\n", what, warning);
}

}  // namespace hemibake
