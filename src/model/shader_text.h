// A model as source text to paste into a shader or a C++ program.
#pragma once

#include <string>
#include <vector>

#include "model/model.h"

namespace hemibake {

enum class Language { glsl, hlsl, cpp };

// Functions of direct_irradiance(ao), first_bounce_irradiance(ao), bounce_ratio(ao) and
// multi_bounce_irradiance(ao, albedo), the last for an RGB albedo (GLSL vec3, HLSL float3, in C++ any struct
// of x, y, z). Finite and within 0..1 for every input, which are clamped to 0..1. origin: comment lines for
// the head of the text, without their "// ": where the constants come from.
std::string shader_text(const BoundedModel& model, Language language, const std::vector<std::string>& origin);
std::string shader_text(const GuardedModel& model, Language language, const std::vector<std::string>& origin);

}  // namespace hemibake
