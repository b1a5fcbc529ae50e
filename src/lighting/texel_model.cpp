#include "lighting/texel_model.h"

#include <algorithm>
#include <type_traits>

#include "textures/light.h"

namespace hemibake {
namespace {

template <class Model, class... Others>
constexpr bool kIsOneOf = (std::is_same_v<Model, Others> || ...);
template <class Model>
constexpr bool kTakesAo = kIsOneOf<Model, BoundedModel, GuardedModel, VisibilityAoModel, MeanEscapeModel>;
template <class Model>
constexpr bool kTakesVisibility = !kIsOneOf<Model, BoundedModel, GuardedModel>;

double total(const VisibilityAoModel& m, const TexelInputs& at, double albedo) {
  return m.total(at.visibility, at.ao, albedo);
}
double total(const MeanEscapeModel& m, const TexelInputs& at, double albedo) {
  return m.total(at.visibility, at.ao, albedo);
}
double total(const VisibilityNormalModel& m, const TexelInputs& at, double albedo) {
  return m.total(at.visibility, at.normal_z, albedo);
}
double total(const BounceMapModel& m, const TexelInputs& at, double albedo) {
  return m.total(at.visibility, at.bounce, albedo);
}
template <class Model>
double total(const Model& m, const TexelInputs& at, double albedo) {
  return m.total(kTakesAo<Model> ? at.ao : at.visibility, albedo);
}

// Solves escape_irradiance for g: the light at albedo r is 1 − (1 − V)(1 − r)/(1 − r + r g).
double escape_of(const BounceMapModel& m, const TexelInputs& at) {
  const double blocked = 1 - at.visibility, missing = std::clamp(1 - at.bounce, 0.0, blocked);
  const double gained = (1 - m.bounce_albedo) / m.bounce_albedo * (blocked - missing);
  return gained < missing ? gained / missing : 1;
}

std::optional<BounceSplit> split(const JimenezModel&, const TexelInputs&) { return std::nullopt; }
std::optional<BounceSplit> split(const VisibilityModel& m, const TexelInputs& at) {
  return BounceSplit{at.visibility, m.escape(at.visibility)};
}
std::optional<BounceSplit> split(const VisibilityAoModel& m, const TexelInputs& at) {
  return BounceSplit{at.visibility, m.escape(at.ao)};
}
std::optional<BounceSplit> split(const MeanEscapeModel& m, const TexelInputs& at) {
  return BounceSplit{at.visibility, m.escape(at.ao)};
}
std::optional<BounceSplit> split(const VisibilityNormalModel& m, const TexelInputs& at) {
  return BounceSplit{at.visibility, m.escape(at.visibility, at.normal_z)};
}
std::optional<BounceSplit> split(const BounceMapModel& m, const TexelInputs& at) {
  return BounceSplit{at.visibility, escape_of(m, at)};
}
template <class ModelOfAo>
std::optional<BounceSplit> split(const ModelOfAo& m, const TexelInputs& at) {
  return BounceSplit{m.direct(at.ao), m.escape(at.ao)};
}

}  // namespace

bool has_visibility(const Bake& bake) { return !bake.visibility.empty() || !bake.irradiance.empty(); }

TexelInputs texel_inputs(const Bake& bake, size_t texel) {
  TexelInputs inputs;
  if (!bake.visible_fraction.empty())
    inputs.ao = std::clamp(static_cast<double>(bake.visible_fraction[texel]), 0.0, 1.0);
  if (has_visibility(bake)) inputs.visibility = visibility_at(bake, texel);
  if (!bake.bounce.empty()) inputs.bounce = std::clamp(static_cast<double>(bake.bounce[texel]), 0.0, 1.0);
  if (!bake.normals.empty())
    inputs.normal_z = std::clamp(static_cast<double>(bake.normals[texel].z), 0.0, 1.0);
  return inputs;
}

std::string missing_plane(const AnyModel& model, const Bake& bake) {
  return std::visit(
      [&]<class Model>(const Model&) -> std::string {
        if (kTakesAo<Model> && bake.visible_fraction.empty()) return "ao";
        if (kTakesVisibility<Model> && !has_visibility(bake)) return "visibility";
        if (std::is_same_v<Model, BounceMapModel> && bake.bounce.empty()) return "bounce";
        if (std::is_same_v<Model, VisibilityNormalModel> && bake.normals.empty()) return "normal";
        return "";
      },
      model);
}

double model_irradiance(const AnyModel& model, const TexelInputs& inputs, double albedo) {
  return std::visit([&](const auto& m) { return total(m, inputs, albedo); }, model);
}

std::optional<BounceSplit> split_bounces(const AnyModel& model, const TexelInputs& inputs) {
  return std::visit([&](const auto& m) { return split(m, inputs); }, model);
}

}  // namespace hemibake
