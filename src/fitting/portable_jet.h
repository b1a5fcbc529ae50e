// Differentiates core/portable_math.h for Ceres, whose own functions of a Jet call the C library's.
#pragma once

#include <ceres/jet.h>

#include "core/portable_math.h"

namespace hemibake {

template <int N>
struct PortableMath<ceres::Jet<double, N>> {
  using Jet = ceres::Jet<double, N>;
  using Number = PortableMath<double>;

  static Jet exp(const Jet& x) {
    const double value = Number::exp(x.a);
    return {value, value * x.v};
  }
  // base: >= 0; of 0 the exponent must be above 0.
  static Jet pow(double base, const Jet& exponent) {
    if (base == 0) return Jet(0);
    const double value = Number::pow(base, exponent.a);
    return {value, Number::log(base) * value * exponent.v};
  }
};

}  // namespace hemibake
