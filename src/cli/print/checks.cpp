#include "cli/print/checks.h"

#include <fmt/format.h>

#include <cmath>

namespace hemibake {
namespace {

// JSON has no infinity and no NaN.
nlohmann::ordered_json finite_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

}  // namespace

std::string table_from_checks(const Checks& checks) {
  std::string text =
      fmt::format("{:7} {:50} {:>13} {:>9} {:>10}\n", "", "quantity", "value", "expected", "tolerance");
  for (const Check& check : checks) {
    const bool judged = std::isfinite(check.tolerance);
    text += fmt::format("{:7} {:50} {:13.7g} {:9g} {:>10}  {}\n",
                        !judged          ? ""
                        : check.passed() ? "ok"
                                         : "FAILED",
                        check.quantity, check.value, check.expected,
                        judged ? fmt::format("{:.1e}", check.tolerance) : "-", check.detail);
  }
  return text;
}

nlohmann::ordered_json json_from_checks(const Checks& checks) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Check& check : checks)
    list.push_back({{"quantity", check.quantity},
                    {"value", finite_or_null(check.value)},
                    {"expected", check.expected},
                    {"tolerance", finite_or_null(check.tolerance)},
                    {"passed", check.passed()},
                    {"detail", check.detail}});
  return {{"passed", all_passed(checks)}, {"checks", list}};
}

}  // namespace hemibake
