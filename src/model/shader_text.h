// Writes a model as source text to paste into a shader or a C++ program.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "model/model.h"
#include "model/shader_language.h"

namespace hemibake {

// Returns the model as functions in `language`, free of conditions (MIT-0). Inputs are clamped to 0..1,
// results finite and in 0..1 (the cubic of Jimenez: up to what its constants add up to at V = 1). The albedo
// is RGB: vec3, float3, vec3f, color, in C++ any struct of x, y, z.
//
// BoundedModel, GuardedModel: direct_irradiance(ao), first_bounce_irradiance(ao), bounce_ratio(ao),
// multi_bounce_irradiance(ao, albedo). VisibilityModel, JimenezModel: multi_bounce_irradiance(visibility,
// albedo). VisibilityAoModel, MeanEscapeModel: multi_bounce_irradiance(visibility, ao_uniform, albedo).
// VisibilityNormalModel: multi_bounce_irradiance(visibility, normal_z, albedo). BounceMapModel:
// multi_bounce(map, albedo). Those of V or a map, but not the cubic: albedo_of_bounces(blurred, own).
// origin: comment lines for the head, without "// ", that say where the constants come from.
// prefix: begins every name; empty: constants and helpers begin with hemibake_, the functions above with
// nothing.
std::string shader_text(const AnyModel& model, Language language, const std::vector<std::string>& origin,
                        std::string_view prefix = {});

}  // namespace hemibake
