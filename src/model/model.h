// Evaluates fitted models in float or double as a shader would (formulas: model/closed_forms.h). Results are
// irradiance relative to an open surface, E/π under a sky of radiance 1.
//
// Every model of α gives, for ao = α and albedo = ρ in 0..1, ends included:
//   direct(α)        F₀, the light that comes straight from the sky
//   first_bounce(α)  F₁, the light of one bounce at albedo 1
//   bounce_ratio(α)  τ, each further bounce over the one before, at albedo 1
//   total(α, ρ)      F₀ + ρF₁/(1 − ρτ), all bounces
#pragma once

#include <algorithm>
#include <array>
#include <variant>

#include "model/closed_forms.h"

namespace hemibake {

// Keeps F₀, F₁ and the total in 0..1 and τ in [0, 1). F₀ and the total rise with α, the total with ρ too;
// F₀ + F₁/(1 − τ) = 1.
struct BoundedModel {
  double k0 = 0.5;  // −1..1: where the visible sky stands, −1 along the horizon, 1 overhead. In the dark…
  double k1 = 1;    // −1..1: …and in the open
  double q = 0.5;  // (0, 1]: share of the light under way that a bounce sends out to the sky, in the open
  double d = 0.8;  // [0, 1): how much less that is in the dark

  template <class T>
  T direct(T ao) const {
    return bounded_direct_factor(ao, static_cast<T>(k0), static_cast<T>(k1));
  }
  template <class T>
  T blocked(T ao) const {
    return bounded_blocked_factor(ao, static_cast<T>(k0), static_cast<T>(k1));
  }
  template <class T>
  T escape(T ao) const {
    return bounded_escape_share(direct(ao), static_cast<T>(q * (1 - d)), static_cast<T>(q));
  }
  template <class T>
  T first_bounce(T ao) const {
    return blocked(ao) * escape(ao);
  }
  template <class T>
  T bounce_ratio(T ao) const {
    return 1 - escape(ao);
  }
  template <class T>
  T total(T ao, T albedo) const {
    return std::min(total_factor(direct(ao), blocked(ao), escape(ao), albedo), T(1));
  }
};

// Evaluates the model of the notes of 2018 unguarded, eq. 7, 9, 10, 11: it has poles (model/README.md).
struct Mayaux2018Model {
  double k = 0.5;
  double e = 0.75;
  double a = 27.576937094210385;
  double b = 3.3364392003423804;

  template <class T>
  T direct(T ao) const {
    return direct_factor(ao, static_cast<T>(k), static_cast<T>(e));
  }
  template <class T>
  T first_bounce(T ao) const {
    return first_bounce_factor(ao, static_cast<T>(a), static_cast<T>(b));
  }
  template <class T>
  T bounce_ratio(T ao) const {
    return 1 - first_bounce(ao) / (1 - direct(ao));
  }
  template <class T>
  T total(T ao, T albedo) const {
    return direct(ao) + albedo * first_bounce(ao) / (1 - albedo * bounce_ratio(ao));
  }
};

// Cuts F₀ of the model of 2018 at 1 and its τ to 0..1: in 0..1 everywhere, unchanged where that model is
// sound.
struct GuardedModel {
  Mayaux2018Model formulas;

  template <class T>
  T direct(T ao) const {
    return std::clamp(formulas.direct(ao), T(0), T(1));
  }
  template <class T>
  T escape(T ao) const {
    const T blocked = 1 - direct(ao);
    const T first = formulas.first_bounce(ao);
    return first < blocked ? std::max(first / blocked, static_cast<T>(kSmallestEscape)) : T(1);
  }
  template <class T>
  T first_bounce(T ao) const {
    return (1 - direct(ao)) * escape(ao);
  }
  template <class T>
  T bounce_ratio(T ao) const {
    return 1 - escape(ao);
  }
  template <class T>
  T total(T ao, T albedo) const {
    const T from_sky = direct(ao);
    return std::min(total_factor(from_sky, 1 - from_sky, escape(ao), albedo), T(1));
  }
};

// Gives all bounces from V alone, with g = dark + (open − dark)V. Rises with V and ρ for all constants.
struct VisibilityModel {
  double dark = 0;  // 0..1: share of the light under way that a bounce sends out to the sky, where V = 0…
  double open = 1;  // 0..1: …and where V = 1

  template <class T>
  T escape(T visibility) const {
    return static_cast<T>(dark) + static_cast<T>(open - dark) * visibility;
  }
  template <class T>
  T total(T visibility, T albedo) const {
    return escape_irradiance(visibility, escape(visibility), albedo);
  }
};

// Gives all bounces from V and α, with g = dark + (open − dark)α; by default g = α, without any constant.
struct VisibilityAoModel {
  double dark = 0;  // 0..1: g where α = 0…
  double open = 1;  // 0..1: …and where α = 1

  template <class T>
  T escape(T ao) const {
    return static_cast<T>(dark) + static_cast<T>(open - dark) * ao;
  }
  template <class T>
  T total(T visibility, T ao, T albedo) const {
    return escape_irradiance(visibility, escape(ao), albedo);
  }
};

// Gives all bounces from V, α and the map's mean escape share m, with g = α(1 + m)/(1 + α).
struct MeanEscapeModel {
  double mean_escape = 1;  // m, 0..1 (mean_escape_share): from AO alone, known before any bounce

  template <class T>
  T escape(T ao) const {
    return mean_escape_share(ao, static_cast<T>(mean_escape));
  }
  template <class T>
  T total(T visibility, T ao, T albedo) const {
    return escape_irradiance(visibility, escape(ao), albedo);
  }
};

// Gives all bounces from V and n.z, with g = V(1.3 − .6 n.z). Rises with V and ρ.
struct VisibilityNormalModel {
  template <class T>
  T escape(T visibility, T normal_z) const {
    return normal_escape_share(visibility, normal_z);
  }
  template <class T>
  T total(T visibility, T normal_z, T albedo) const {
    return escape_irradiance(visibility, escape(visibility, normal_z), albedo);
  }
};

// Gives all bounces from two textures, V and E/π at one albedo: the planes `visibility` and `bounce` of a
// bake.
struct BounceMapModel {
  double bounce_albedo = 0.9;  // r, inside 0..1: albedo of the second texture

  template <class T>
  T total(T visibility, T bounce, T albedo) const {
    return bounce_map_irradiance(visibility, bounce, albedo, static_cast<T>(bounce_albedo));
  }
};

// Holds a model of α that pictures and the report can be made with.
using ShaderModel = std::variant<BoundedModel, GuardedModel>;

// Evaluates max(V, jimenez_cubic), by default with the constants of Jimenez et al. 2016: all bounces at once.
// visibility: V = E₀/π, the cosine-weighted visible fraction, not α.
struct JimenezModel {
  std::array<double, 6> parameters = kJimenezConstants;

  template <class T>
  T total(T visibility, T albedo) const {
    std::array<T, 6> p;
    std::transform(parameters.begin(), parameters.end(), p.begin(),
                   [](double v) { return static_cast<T>(v); });
    return std::max(visibility, jimenez_cubic(visibility, albedo, p.data()));
  }
};

// Holds any model that text and tables can be made of.
using AnyModel = std::variant<VisibilityModel, VisibilityNormalModel, VisibilityAoModel, MeanEscapeModel,
                              BounceMapModel, BoundedModel, GuardedModel, JimenezModel>;

// Returns a model of α as any model.
inline AnyModel any_model(const ShaderModel& model) {
  return std::visit([](const auto& m) { return AnyModel(m); }, model);
}

}  // namespace hemibake
