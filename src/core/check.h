// One line of a table of checks: a quantity, what it should be, and whether it is.
#pragma once

#include <cmath>
#include <string>
#include <vector>

namespace hemibake {

struct Check {
  std::string quantity;
  double value = 0;
  double expected = 0;
  double tolerance = 0;  // largest |value − expected| that passes; infinity: for information only
  std::string detail;    // where the worst is, or what the tolerance is made of

  // A value that is not a number passes nothing.
  bool passed() const { return std::abs(value - expected) <= tolerance; }
};

using Checks = std::vector<Check>;

inline bool all_passed(const Checks& checks) {
  for (const Check& check : checks)
    if (!check.passed()) return false;
  return true;
}

}  // namespace hemibake
