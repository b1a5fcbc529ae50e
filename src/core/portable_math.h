// Evaluates exp, log and pow with the same bytes on every x86-64 machine.
//
// The C library chooses its functions of double by whether the machine multiplies and adds in one rounding
// (FMA), and the two round differently. Those of long double have no such choice: their result, rounded to
// double, is the same everywhere.
#pragma once

#include <cmath>

namespace hemibake {

// Defined for float, double, and in fitting/portable_jet.h for the dual numbers of Ceres over double.
template <class T>
struct PortableMath;

template <>
struct PortableMath<double> {
  static double exp(double x) { return static_cast<double>(std::exp(static_cast<long double>(x))); }
  static double log(double x) { return static_cast<double>(std::log(static_cast<long double>(x))); }
  static double pow(double base, double exponent) {
    return static_cast<double>(std::pow(static_cast<long double>(base), static_cast<long double>(exponent)));
  }
};

template <>
struct PortableMath<float> {
  static float exp(float x) { return static_cast<float>(PortableMath<double>::exp(static_cast<double>(x))); }
  static float pow(float base, float exponent) {
    return static_cast<float>(
        PortableMath<double>::pow(static_cast<double>(base), static_cast<double>(exponent)));
  }
};

}  // namespace hemibake
