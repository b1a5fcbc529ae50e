#include "core/confidence.h"

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <limits>

namespace hemibake {
namespace {

// Returns x with P(|X| ≤ x) = confidence. From the upper tail, where 1 − confidence has no rounding.
template <class Distribution>
double two_sided_quantile(const Distribution& distribution, double confidence) {
  return boost::math::quantile(boost::math::complement(distribution, (1 - confidence) / 2));
}

}  // namespace

double normal_quantile(double confidence) {
  return two_sided_quantile(boost::math::normal_distribution<double>(), confidence);
}

double student_quantile(double confidence, double degrees_of_freedom) {
  if (!(degrees_of_freedom >= 1)) return std::numeric_limits<double>::infinity();
  return two_sided_quantile(boost::math::students_t_distribution<double>(degrees_of_freedom), confidence);
}

}  // namespace hemibake
