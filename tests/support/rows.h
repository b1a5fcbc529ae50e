// Traces single rows in tests.
#pragma once

#include "tracers/tracer.h"

namespace hemibake {

inline Row texel_row(const Tracer& tracer, uint32_t texel, bool with_links = true) {
  Row row;
  TracerCounts counts;
  tracer.trace_texel(texel, with_links, row, counts);
  return row;
}

inline Row patch_row(const Tracer& tracer, uint32_t patch, bool with_links = true) {
  Row row;
  TracerCounts counts;
  tracer.trace_patch(patch, with_links, row, counts);
  return row;
}

inline double form_factor_sum(const Row& row) {
  double sum = 0;
  for (const FormFactor& link : row.links) sum += static_cast<double>(link.weight);
  return sum;
}

// Returns what complete_row makes 1.
inline double row_sum(const Row& row) {
  return static_cast<double>(static_cast<float>(row.direct_over_pi)) + form_factor_sum(row);
}

}  // namespace hemibake
