#include "surface/holes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/context.h"
#include "core/error.h"

namespace hemibake {
namespace {

constexpr double kTolerance = 1e-7;  // of the heights' range, rms over the holes
constexpr size_t kMostSteps = 100000;

constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

// Holes as unknowns: (4 − neighbours that are missing) h − Σ h of neighbouring holes = Σ h of the rim.
struct Membrane {
  std::vector<uint32_t> texels;                     // of the unknowns
  std::vector<std::array<uint32_t, 4>> neighbours;  // unknowns; kNone: rim or border
  std::vector<double> diagonal, rim;
};

Membrane make_membrane(const Grid<uint8_t>& holes, Edge edge, const Grid<float>& heights) {
  constexpr std::array<std::array<int, 2>, 4> kSteps = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  std::vector<uint32_t> unknown(heights.size(), kNone);
  Membrane membrane;
  for (size_t i = 0; i < holes.size(); ++i) {
    if (holes[i] == 0) continue;
    unknown[i] = static_cast<uint32_t>(membrane.texels.size());
    membrane.texels.push_back(static_cast<uint32_t>(i));
  }
  const auto width = static_cast<uint32_t>(heights.width);
  for (const uint32_t texel : membrane.texels) {
    const int x = static_cast<int>(texel % width), y = static_cast<int>(texel / width);
    std::array<uint32_t, 4> neighbours{kNone, kNone, kNone, kNone};
    double diagonal = 0, rim = 0;
    for (size_t k = 0; k < kSteps.size(); ++k) {
      int i = x + kSteps[k][0], j = y + kSteps[k][1];
      const bool inside = i >= 0 && j >= 0 && i < heights.width && j < heights.height;
      if (!inside && edge != Edge::kWrap) continue;
      i = wrap_index(i, heights.width);
      j = wrap_index(j, heights.height);
      diagonal += 1;
      neighbours[k] = unknown[heights.index(i, j)];
      if (neighbours[k] == kNone) rim += static_cast<double>(heights(i, j));
    }
    membrane.neighbours.push_back(neighbours);
    membrane.diagonal.push_back(diagonal);
    membrane.rim.push_back(rim);
  }
  return membrane;
}

void multiply(const Membrane& membrane, const std::vector<double>& values, std::vector<double>& result) {
  for (size_t i = 0; i < values.size(); ++i) {
    double sum = membrane.diagonal[i] * values[i];
    for (const uint32_t k : membrane.neighbours[i])
      if (k != kNone) sum -= values[k];
    result[i] = sum;
  }
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

// Solves for the heights by conjugate gradients, preconditioned with the diagonal (Hestenes, Stiefel 1952).
// heights: the start. tolerance: rms of the last steps' residual.
void relax(const Membrane& membrane, double tolerance, std::vector<double>& heights) {
  const size_t count = heights.size();
  std::vector<double> residual(count), scaled(count), direction(count), product(count);
  multiply(membrane, heights, product);
  for (size_t i = 0; i < count; ++i) residual[i] = membrane.rim[i] - product[i];
  const double enough = tolerance * tolerance * static_cast<double>(count);
  double last = 0;
  for (size_t step = 0; step < kMostSteps && dot(residual, residual) > enough; ++step) {
    throw_if_cancelled();
    for (size_t i = 0; i < count; ++i) scaled[i] = residual[i] / membrane.diagonal[i];
    const double now = dot(residual, scaled);
    for (size_t i = 0; i < count; ++i) direction[i] = scaled[i] + (step > 0 ? now / last : 0) * direction[i];
    multiply(membrane, direction, product);
    const double length = now / dot(direction, product);
    for (size_t i = 0; i < count; ++i) {
      heights[i] += length * direction[i];
      residual[i] -= length * product[i];
    }
    last = now;
  }
}

}  // namespace

size_t fill_holes(const Grid<uint8_t>& holes, Edge edge, Grid<float>& heights) {
  if (std::ranges::find(holes.values, uint8_t{1}) == holes.values.end()) return 0;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (size_t i = 0; i < heights.size(); ++i) {
    if (holes[i] != 0) continue;
    low = std::min(low, static_cast<double>(heights[i]));
    high = std::max(high, static_cast<double>(heights[i]));
  }
  if (low > high) throw InputError("no texel has a height, expected one at least");
  const Membrane membrane = make_membrane(holes, edge, heights);
  std::vector<double> filled(membrane.texels.size(), 0.5 * (low + high));
  relax(membrane, kTolerance * (high - low), filled);
  for (size_t i = 0; i < filled.size(); ++i)
    heights[membrane.texels[i]] = static_cast<float>(std::clamp(filled[i], low, high));
  return filled.size();
}

}  // namespace hemibake
