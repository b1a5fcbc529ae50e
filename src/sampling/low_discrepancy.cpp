#include "sampling/low_discrepancy.h"

namespace hemibake {

double radical_inverse(uint32_t base, uint32_t index) {
  const double digit_value = 1.0 / base;
  double scale = digit_value, result = 0;
  for (; index > 0; index /= base, scale *= digit_value) result += scale * (index % base);
  return result;
}

}  // namespace hemibake
