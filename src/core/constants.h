#pragma once

#include <numbers>

namespace hemibake {

inline constexpr double kPi = std::numbers::pi;

}  // namespace hemibake
