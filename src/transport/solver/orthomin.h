// Solves E = direct + W diag(albedo) E between patches in far fewer products than bounce after bounce.
//
// Orthomin, truncated generalised conjugate residuals (Eisenstat, Elman and Schultz, "Variational Iterative
// Methods for Nonsymmetric Systems of Linear Equations", SIAM J. Numer. Anal. 20, 1983): every step takes one
// product and makes the residual's 2-norm as small as the last four directions allow. W is symmetric under
// the patches' areas but for noise, so that few directions do nearly as well as all.
//
// From the ninth step on it is preconditioned by block Jacobi: with G the inverse of I − W diag(albedo)
// within groups of patches that see little but each other (block_jacobi.h), it minimises G (direct − E + W
// diag(albedo) E). Problems that end sooner do not pay for the groups.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "transport/links/form_factors.h"
#include "transport/solver/block_jacobi.h"

namespace hemibake {

class Orthomin {
 public:
  // form_factors: patch × patch, must outlive the solver. albedo: one per patch, 0..1; empty: 1 everywhere;
  // must outlive the solver. start: any light, one per patch. residual: direct + W diag(albedo) start −
  // start.
  Orthomin(const FormFactorMatrix& form_factors, std::span<const float> albedo, std::vector<double> start,
           std::vector<double> residual);

  // Makes one step, of one product. Returns false, and does nothing, if the residual is zero or no direction
  // reduces it.
  bool step();

  const std::vector<double>& light() const { return light_; }
  // Returns the largest residual r of a patch: error / bound ≤ r ≤ 2 · largest error, for any bound of the
  // row sums of (I − W diag(albedo))⁻¹. It holds with groups too: G is at least 1, and G W passes on no more
  // than W.
  double largest_residual() const;
  // Returns the work of all steps so far, in products.
  double work() const { return work_; }

 private:
  struct Direction {
    std::vector<double> change, reduction;  // of the light; of the residual
    double norm_squared = 0;
  };

  const FormFactorMatrix& form_factors_;
  std::span<const float> albedo_;
  std::vector<double> light_, residual_;
  std::vector<Direction> kept_;
  size_t oldest_ = 0;
  int steps_ = 0;
  double work_ = 0;
  std::optional<BlockJacobi> groups_;
};

// Sends light on by one bounce: out = W diag(albedo) light. albedo: one per column, 0..1; empty: 1
// everywhere.
void apply_transport(const FormFactorMatrix& form_factors, std::span<const float> albedo,
                     std::span<const double> light, std::vector<double>& out);

}  // namespace hemibake
