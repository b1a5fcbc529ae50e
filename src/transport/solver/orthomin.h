// Solves E = direct + W diag(albedo) E between patches in far fewer products than bounce after bounce.
//
// Generalised conjugate residuals, truncated (Orthomin: Eisenstat, Elman and Schultz, "Variational Iterative
// Methods for Nonsymmetric Systems of Linear Equations", SIAM J. Numer. Anal. 20, 1983): every step takes one
// product and makes the residual's 2-norm as small as the last directions allow. W is symmetric under the
// patches' areas but for noise, so that few directions do nearly what all would: on WallHeight at 0.1 m four
// need no more products than all, BiCGSTAB (Eigen's) half as many again.
//
// What is slow then are nodes in the bottom of pits, of which two to six see little but each other. From the
// ninth step on their light is followed to the end inside such groups (transport/solver/block_jacobi.h): with
// G the inverse of I − W diag(albedo) within groups, G (direct − E + W diag(albedo) E) is made small. That is
// a third of the products on WallHeight; problems that end sooner do not pay for it. (E corrected by G
// instead, the residual as it is, comes to a standstill.)
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "transport/links/form_factors.h"
#include "transport/solver/block_jacobi.h"

namespace hemibake {

class Orthomin {
 public:
  // links: patch × patch. albedo: one per patch, 0..1; empty: 1 everywhere. start: any light. residual:
  // direct + W diag(albedo) start − start. Both references must outlive the solver.
  Orthomin(const FormFactorMatrix& links, std::span<const float> albedo, std::vector<double> start,
           std::vector<double> residual);

  // One product. False, and nothing done, where there is nothing left to do: the residual is zero, or no
  // direction reduces it.
  bool step();

  const std::vector<double>& light() const { return light_; }
  // Times a bound of the rows of (I − W diag(albedo))⁻¹ it bounds the error, and it is at most twice the
  // largest error, with groups too: what these pass on adds up to no more than it did, and G is at least 1.
  double largest_residual() const;
  // Of all steps so far, in readings of the links: a product is one.
  double work() const { return work_; }

 private:
  struct Direction {
    std::vector<double> change, reduction;  // of the light; of the residual
    double norm_squared = 0;
  };

  const FormFactorMatrix& links_;
  std::span<const float> albedo_;
  std::vector<double> light_, residual_;
  std::vector<Direction> kept_;
  size_t oldest_ = 0;
  int steps_ = 0;
  double work_ = 0;
  std::optional<BlockJacobi> groups_;
};

// out = links · diag(albedo) · light; albedo as above.
void apply_transport(const FormFactorMatrix& links, std::span<const float> albedo,
                     std::span<const double> light, std::vector<double>& out);

}  // namespace hemibake
