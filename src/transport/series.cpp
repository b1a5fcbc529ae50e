#include "transport/series.h"

#include <algorithm>

namespace hemibake {

double series_tail(double before, double last, double albedo, double most) {
  // A larger ratio adds nothing that is seen: it only brings bounces after about the thousandth.
  constexpr double kLargestRatio = 0.999;
  if (!(before > 0 && last > 0)) return 0;
  const double ratio = std::min({last / before, albedo, kLargestRatio});
  return std::min(last * ratio / (1 - ratio), std::max(0.0, most));
}

}  // namespace hemibake
