#include "cli/validators.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <string>

namespace hemibake {
namespace {

std::optional<double> number_from(std::string text) {
  double value = 0;
  if (!CLI::detail::lexical_cast(text, value) || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<uint64_t> whole_number_from(const std::string& text) {
  if (text.size() > 1 && text.front() == '0') return std::nullopt;
  uint64_t value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

}  // namespace

CLI::Validator number_in(double low, double high) {
  const std::string range = fmt::format("[{} - {}]", low, high);
  return {[low, high](std::string& text) {
            const std::optional<double> value = number_from(text);
            return value && *value >= low && *value <= high
                       ? ""
                       : fmt::format("'{}', expected a number from {} to {}", text, low, high);
          },
          "in " + range};
}

CLI::Validator positive_to(double high) {
  return {[high](std::string& text) {
            const std::optional<double> value = number_from(text);
            return value && *value > 0 && *value <= high
                       ? ""
                       : fmt::format("'{}', expected a number above 0, at most {}", text, high);
          },
          fmt::format("in (0 - {}]", high)};
}

CLI::Validator whole_number_in(uint64_t low, uint64_t high) {
  return {[low, high](std::string& text) {
            const std::optional<uint64_t> value = whole_number_from(text);
            return value && *value >= low && *value <= high
                       ? ""
                       : fmt::format("'{}', expected a whole number from {} to {}", text, low, high);
          },
          fmt::format("in [{} - {}]", low, high)};
}

}  // namespace hemibake
