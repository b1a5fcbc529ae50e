#include "core/error.h"

#include <fmt/format.h>

namespace hemibake {

void fail_expectation(const std::string& what, double actual, double expected) {
  throw std::logic_error(fmt::format("internal check failed: {} is {}, expected {}", what, actual, expected));
}

}  // namespace hemibake
