#include "transport/solver/orthomin.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/parallel.h"

namespace hemibake {
namespace {

constexpr size_t kGrain = 16384;
constexpr size_t kDirectionsKept = 4;
// Groups cost about ten products; at albedo 0.5 the solver ends before.
constexpr int kStepsBeforeGroups = 8;

// Returns a · b, summed piece by piece in an order that does not depend on the threads.
double dot(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> pieces((a.size() + kGrain - 1) / kGrain);
  parallel_for(a.size(), kGrain, [&](size_t begin, size_t end) {
    double sum = 0;
    for (size_t i = begin; i < end; ++i) sum += a[i] * b[i];
    pieces[begin / kGrain] = sum;
  });
  double sum = 0;
  for (const double piece : pieces) sum += piece;
  return sum;
}

// Adds: a += factor · b.
void add_scaled(double factor, const std::vector<double>& b, std::vector<double>& a) {
  parallel_for(a.size(), kGrain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) a[i] += factor * b[i];
  });
}

// Rounds light to values whose reflection is a float, as multiply() makes it: without that the residual
// drifts from its true value by more than deep pits allow.
void round_for_product(std::span<const float> albedo, std::vector<double>& light) {
  parallel_for(light.size(), kGrain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const double factor = albedo.empty() ? 1 : static_cast<double>(albedo[i]);
      if (factor > 0) light[i] = static_cast<double>(static_cast<float>(factor * light[i])) / factor;
    }
  });
}

}  // namespace

Orthomin::Orthomin(const FormFactorMatrix& form_factors, std::span<const float> albedo,
                   std::vector<double> start, std::vector<double> residual)
    : form_factors_(form_factors),
      albedo_(albedo),
      light_(std::move(start)),
      residual_(std::move(residual)) {}

bool Orthomin::step() {
  if (steps_ == kStepsBeforeGroups && !groups_) {
    groups_ = make_block_jacobi(form_factors_, albedo_);
    apply_block_jacobi(*groups_, residual_);
    kept_.clear();
    oldest_ = 0;
    work_ += 2;
  }
  Direction next;
  if (kept_.size() == kDirectionsKept) next = std::move(kept_[oldest_]);
  const bool replaces = !next.change.empty();
  next.change = residual_;
  round_for_product(albedo_, next.change);
  apply_transport(form_factors_, albedo_, next.change, next.reduction);
  work_ += 1;
  if (groups_ && !groups_->inverse.empty())
    work_ += static_cast<double>(groups_->inverse.size()) / static_cast<double>(form_factors_.count());
  parallel_for(next.change.size(), kGrain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) next.reduction[i] = next.change[i] - next.reduction[i];
  });
  if (groups_) apply_block_jacobi(*groups_, next.reduction);
  for (const Direction& direction : kept_) {
    if (direction.change.empty()) continue;
    const double share = -dot(next.reduction, direction.reduction) / direction.norm_squared;
    add_scaled(share, direction.change, next.change);
    add_scaled(share, direction.reduction, next.reduction);
  }
  next.norm_squared = dot(next.reduction, next.reduction);
  const double length = dot(residual_, next.reduction) / next.norm_squared;
  if (!std::isfinite(length) || length == 0) return false;
  add_scaled(length, next.change, light_);
  add_scaled(-length, next.reduction, residual_);
  ++steps_;
  if (replaces) {
    kept_[oldest_] = std::move(next);
    oldest_ = (oldest_ + 1) % kDirectionsKept;
  } else {
    kept_.push_back(std::move(next));
  }
  return true;
}

double Orthomin::largest_residual() const {
  double largest = 0;
  for (const double value : residual_) largest = std::max(largest, std::abs(value));
  return largest;
}

void apply_transport(const FormFactorMatrix& form_factors, std::span<const float> albedo,
                     std::span<const double> light, std::vector<double>& out) {
  out.resize(form_factors.rows);
  if (albedo.empty()) return multiply(form_factors, light, out);
  std::vector<double> reflected(light.size());
  parallel_for(light.size(), kGrain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) reflected[i] = static_cast<double>(albedo[i]) * light[i];
  });
  multiply(form_factors, reflected, out);
}

}  // namespace hemibake
