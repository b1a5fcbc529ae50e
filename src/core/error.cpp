#include "core/error.h"

#include <fmt/format.h>

namespace hemibake {

std::string SettingError::text(const std::string& message, const std::string& file,
                               const std::string& prefix) {
  std::string text = file.empty() ? "" : file + ": ";
  for (const char c : message)
    if (c == '{')
      text += prefix;
    else if (c != '}')
      text += c;
  return text;
}

void fail_expectation(const std::string& what, double actual, double expected) {
  throw std::logic_error(fmt::format("internal check failed: {} is {}, expected {}", what, actual, expected));
}

}  // namespace hemibake
