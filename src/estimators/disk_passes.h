// Sums shadows over a tree of disks, in passes over all receivers: shared by the disk estimators.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "core/parallel.h"
#include "core/progress.h"

namespace hemibake {

// Adds up the shadow over one receiver, disk by disk.
struct ShadowSum {
  double total = 0;
  glm::dvec3 direction{0};  // Σ shadow · unit direction to the disk

  void add(double shadow, const glm::dvec3& offset) {
    total += shadow;
    direction += shadow / glm::length(offset) * offset;
  }
  double accessibility() const { return std::clamp(1 - total, 0.0, 1.0); }
  glm::dvec3 bent_normal(const glm::dvec3& normal) const {
    const glm::dvec3 bent = normal - direction;
    const double length = glm::length(bent);
    return length > 0 ? bent / length : normal;
  }
};

// Calls body(receiver) for every receiver in parallel. Returns the sum of the nodes visited, which body
// returns.
template <class Body>
uint64_t for_each_receiver(size_t count, Progress& progress, const Body& body) {
  constexpr size_t kGrain = 256;
  std::atomic<uint64_t> work{0};
  parallel_for(count, kGrain, [&](size_t begin, size_t end) {
    uint64_t piece = 0;
    for (size_t i = begin; i < end; ++i) piece += body(i);
    work += piece;
    progress.advance(end - begin);
  });
  return work;
}

}  // namespace hemibake
