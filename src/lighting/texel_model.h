// Evaluates any model at the texels of a bake.
#pragma once

#include <optional>
#include <string>

#include "model/model.h"
#include "transport/baked_planes.h"

namespace hemibake {

// Holds what models take of a texel, each 0..1; 0 where the bake holds nothing of it.
struct TexelInputs {
  double ao = 0;          // α
  double visibility = 0;  // V
  double bounce = 0;      // E/π at the albedo of the bounce map
  double normal_z = 0;    // of the shading normal
};

// Returns whether a bake gives V: by its plane `visibility`, or by E₀.
bool has_visibility(const Bake& bake);

TexelInputs texel_inputs(const Bake& bake, size_t texel);

// Returns the name of a plane that the model takes and the bake lacks: ao, visibility, bounce or normal; or
// nothing.
std::string missing_plane(const AnyModel& model, const Bake& bake);

// Returns E/π over all bounces. albedo: ρ, 0..1.
double model_irradiance(const AnyModel& model, const TexelInputs& inputs, double albedo);

// Holds a model's light of single bounces at albedo 1: E₀/π is direct, E_b/π = (1 − direct) escape (1 −
// escape)^(b−1).
struct BounceSplit {
  double direct = 0;
  double escape = 1;  // g = 1 − τ, 0..1
};

// Returns the light of single bounces; none where the model is of their sum only, as the cubic of Jimenez is.
std::optional<BounceSplit> split_bounces(const AnyModel& model, const TexelInputs& inputs);

}  // namespace hemibake
