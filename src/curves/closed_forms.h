// The formulas of the curves, F_b(α) = E_b/π at albedo 1, as templates: float and double for evaluation
// (model/), Ceres' derivative-carrying numbers for fitting (fitting/). They are here, in the lowest folder
// that both include, so that a fitted formula and an evaluated one cannot differ.
//
// X: the type of α (float or double); T: the type of the parameters (X, or a Ceres Jet over X).
//
// Source: B. Mayaux, "Study Notes: Improved Ambient Occlusion", 2018 (the notes).
#pragma once

#include <cmath>

namespace hemibake {

// 1 − α, and 0 where α exceeds 1: the published abscissa runs to 100/99.
template <class X>
X complement(X ao) {
  return ao < X(1) ? X(1) - ao : X(0);
}

// F₀(α) = α(1 + k(1−α)^e), notes eq. 7 with k = ½, e = ¾. Below 1 everywhere where e >= 1 and 0 <= k <= 1.
template <class T, class X>
T direct_factor(X ao, const T& k, const T& e) {
  using std::pow;
  return ao * (T(1) + k * pow(complement(ao), e));
}

// F₁(α) = A α (1−α)^1.5 exp(−B α^¼), notes eq. 11.
template <class T, class X>
T first_bounce_factor(X ao, const T& a, const T& b) {
  using std::exp;
  using std::sqrt;
  const X rest = complement(ao);
  return ao * rest * sqrt(rest) * a * exp(-b * sqrt(sqrt(ao)));
}

// F_b(α) = A α (1−α)^1.5 exp(−B α^C), notes, "Summing the Curves": one set of A, B, C for each bounce b >= 1.
// α > 0.
template <class T, class X>
T bounce_factor(X ao, const T& a, const T& b, const T& c) {
  using std::exp;
  using std::pow;
  using std::sqrt;
  const X rest = complement(ao);
  return ao * rest * sqrt(rest) * a * exp(-b * pow(ao, c));
}

}  // namespace hemibake
