// Solves E = direct + W diag(albedo) E between patches in far fewer products than bounce after bounce.
//
// Generalised conjugate residuals, truncated (Orthomin: Eisenstat, Elman and Schultz, "Variational Iterative
// Methods for Nonsymmetric Systems of Linear Equations", SIAM J. Numer. Anal. 20, 1983): every step takes one
// product and makes the residual's 2-norm as small as the last directions allow. W is symmetric under the
// patches' areas but for noise, so that few directions do nearly what all would: on WallHeight at 0.1 m four
// need no more products than all, BiCGSTAB (Eigen's) half as many again.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "transport/links.h"

namespace hemibake {

class LightSolver {
 public:
  // links: patch × patch. albedo: one per patch, 0..1; empty: 1 everywhere. start: any light. residual:
  // direct + W diag(albedo) start − start. Both references must outlive the solver.
  LightSolver(const Links& links, std::span<const float> albedo, std::vector<double> start,
              std::vector<double> residual);

  // One product. False, and nothing done, where there is nothing left to do: the residual is zero, or no
  // direction reduces it.
  bool step();

  const std::vector<double>& light() const { return light_; }
  double largest_residual() const;

 private:
  struct Direction {
    std::vector<double> change, reduction;  // of the light; of the residual
    double norm_squared = 0;
  };

  const Links& links_;
  std::span<const float> albedo_;
  std::vector<double> light_, residual_;
  std::vector<Direction> kept_;
  size_t oldest_ = 0;
};

// out = links · diag(albedo) · light; albedo as above.
void reflect(const Links& links, std::span<const float> albedo, std::span<const double> light,
             std::vector<double>& out);

}  // namespace hemibake
