// Defines the formulas of the curves, F_b(α) = E_b/π at albedo 1, once for evaluation and fitting.
//
// X: the type of α (float or double); T: the type of the parameters (X, or a Ceres Jet over X).
//
// Source: B. Mayaux, "Study Notes: Improved Ambient Occlusion", 2018 (the notes).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/portable_math.h"

namespace hemibake {

// Returns max(1 − α, 0): the abscissa of 2018 runs to 100/99.
template <class X>
X complement(X ao) {
  return ao < X(1) ? X(1) - ao : X(0);
}

// Returns F₀(α) = α(1 + k(1−α)^e), notes eq. 7 with k = ½, e = ¾. At most 1 for e >= 1, 0 <= k <= 1.
template <class T, class X>
T direct_factor(X ao, const T& k, const T& e) {
  return ao * (T(1) + k * PortableMath<T>::pow(complement(ao), e));
}

// Returns F₁(α) = A α (1−α)^1.5 exp(−B α^¼), notes eq. 11.
template <class T, class X>
T first_bounce_factor(X ao, const T& a, const T& b) {
  using std::sqrt;
  const X rest = complement(ao);
  return ao * rest * sqrt(rest) * a * PortableMath<T>::exp(-b * sqrt(sqrt(ao)));
}

// Returns F_b(α) = A α (1−α)^1.5 exp(−B α^C), notes, "Summing the Curves"; α > 0.
// a, b, c: one set for each bounce b >= 1.
template <class T, class X>
T bounce_factor(X ao, const T& a, const T& b, const T& c) {
  using std::sqrt;
  const X rest = complement(ao);
  return ao * rest * sqrt(rest) * a * PortableMath<T>::exp(-b * PortableMath<T>::pow(ao, c));
}

// Returns F₀ = α(1 + (1−α) s(α)) of the bounded model, s = k0 + (k1 − k0) α². Lies between α² (s = −1, the
// visible sky along the horizon) and α(2−α) (s = 1, overhead), and rises from 0 to 1.
// k0, k1: −1..1; both 0 is plain AO.
template <class T, class X>
T bounded_direct_factor(X ao, const T& k0, const T& k1) {
  return ao * (T(1) + (X(1) - ao) * (k0 + (k1 - k0) * (ao * ao)));
}

// Returns 1 − bounded_direct_factor, (1−α)((1−α) + α(1−s)), without cancellation near α = 1, also with k1
// = 1.
template <class T, class X>
T bounded_blocked_factor(X ao, const T& k0, const T& k1) {
  const X rest = X(1) - ao;
  return rest * (rest + ao * ((T(1) - k1) + (k1 - k0) * (rest * (X(1) + ao))));
}

// Returns 1 − τ of the bounded model, the share of the light under way that each bounce sends out to the sky:
// q(1 − d(1−F₀)/(1+3F₀)), written as dark + (open − dark) · 4F₀/(1+3F₀), where no 1 − d cancels.
// direct: F₀, 0..1. dark: q(1−d), the share at F₀ = 0. open: q, at F₀ = 1.
template <class T, class X>
T bounded_escape_share(X direct, const T& dark, const T& open) {
  return dark + (open - dark) * (X(4) * direct / (X(1) + X(3) * direct));
}

// Returns E/π over all bounces, notes eq. 10 with F₁ = (1 − F₀)(1 − τ) so that no light is lost at albedo 1:
// F₀ + (1 − F₀) ρ(1−τ)/(1 − ρ + ρ(1−τ)).
// direct: F₀; blocked: 1 − F₀; escape: 1 − τ; albedo: ρ; all 0..1, escape above 0 where albedo is 1.
template <class T, class X>
T total_factor(X direct, X blocked, const T& escape, X albedo) {
  const T out = albedo * escape;
  return direct + blocked * (out / (X(1) - albedo + out));
}

// Returns E/π over all bounces, 1 − (1−V)(1−ρ)/(1 − ρ + ρg): total_factor from V and the escape share g. V at
// ρ = 0, 1 at ρ = 1, in [V, 1], rises with V, g and ρ.
// visibility: V = E₀/π, 0..1. escape: g = 1 − τ, the share of the light under way that each bounce sends out
// to the sky, 0..1. albedo: ρ, 0..1. Source: eq. 10 of the notes; with g = V, Stewart and Langer 1997,
// "Towards Accurate Recovery of Shape from Shading under Diffuse Lighting".
template <class T, class X>
T escape_irradiance(X visibility, const T& escape, X albedo) {
  const X kept = X(1) - albedo;
  if (kept == X(0)) return T(1);  // also where no light escapes
  return T(1) - (X(1) - visibility) * (kept / (kept + albedo * escape));
}

// Returns g = α(1 + m)/(1 + α). It is α where α = m, more below and less above: shares lie nearer to their
// map's mean than α does. Rises with α and m, in 0..1: at α = 1 it is (1 + m)/2.
// ao: α, 0..1. mean_escape: m = (⟨V⟩ − ⟨V²⟩)/(1 − ⟨V⟩) of the map, 0..1; 1 of flat ground. Form factors times
// areas are symmetric, so the first bounce brings ⟨V(1−V)⟩ on average: m is the mean of its true g, weighted
// by 1 − V. Chosen on the maps of fits/README.md, "Tiers".
template <class X>
X mean_escape_share(X ao, X mean_escape) {
  return ao * (X(1) + mean_escape) / (X(1) + ao);
}

// Constants of normal_escape_share: its factor where n.z = 0, and how much that falls to n.z = 1. Rounded
// from a fit to the maps of fits/README.md, "Tiers".
inline constexpr double kSteepEscape = 1.3;
inline constexpr double kEscapeFall = 0.6;

// Returns g = V(1.3 − .6 n.z), at most 1. Rises with V for every n.z; at the same V, light leaves a wall more
// easily than a floor.
// visibility: V, 0..1. normal_z: n.z of the shading normal in the frame of the large surface, 0..1.
template <class X>
X normal_escape_share(X visibility, X normal_z) {
  return std::min(visibility * (static_cast<X>(kSteepEscape) - static_cast<X>(kEscapeFall) * normal_z), X(1));
}

// Returns E/π over all bounces from the light at two albedos: the curve through (0, V), (r, E_r) and (1, 1)
// that escape_irradiance draws with the g of the texel. In [V, 1], rises with ρ and E_r; with V up to ρ = r,
// and beyond r it falls with V, since the same E_r then needs a smaller g.
// visibility: V, 0..1. bounce: E_r, E/π of all bounces at albedo r, 0..1; below V it counts as V. albedo: ρ,
// 0..1. bounce_albedo: r, inside 0..1.
template <class X>
X bounce_map_irradiance(X visibility, X bounce, X albedo, X bounce_albedo) {
  if (albedo == X(1)) return X(1);
  const X blocked = X(1) - visibility;
  const X missing = std::clamp(X(1) - bounce, X(0), blocked);
  const X kept = (X(1) - albedo) * missing;
  const X gained = albedo * ((X(1) - bounce_albedo) / bounce_albedo) * (blocked - missing);
  if (kept + gained == X(0)) return visibility;  // E_r = 1 at ρ = 0, or V = 1
  return X(1) - blocked * (kept / (kept + gained));
}

// Smallest 1 − τ of the guarded model: the formulas give 0 at α = 0, where the total at ρ = 1 would be 0/0.
inline constexpr double kSmallestEscape = 1e-30;

// Returns the cubic ((aV + b)V + c)V with a = p0 ρ + p1, b = p2 ρ + p3, c = p4 ρ + p5: Jimenez et al.,
// "Practical Real-Time Strategies for Accurate Indirect Occlusion", 2016, chapter 5, without its max(V, ·).
// visibility: V = E₀/π, the cosine-weighted visible fraction, not α.
template <class T, class X>
T jimenez_cubic(X visibility, X albedo, const T* p) {
  const T a = p[0] * albedo + p[1];
  const T b = p[2] * albedo + p[3];
  const T c = p[4] * albedo + p[5];
  return ((a * visibility + b) * visibility + c) * visibility;
}

// Constants of Jimenez et al. 2016, p0..p5.
inline constexpr std::array<double, 6> kJimenezConstants = {2.0404, -0.3324, -4.7951, 0.6417, 2.7552, 0.6903};

}  // namespace hemibake
