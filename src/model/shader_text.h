// Writes a model as source text to paste into a shader or a C++ program.
#pragma once

#include <string>
#include <vector>

#include "model/model.h"

namespace hemibake {

enum class Language { kGlsl, kHlsl, kCpp };

// Returns direct_irradiance(ao), first_bounce_irradiance(ao), bounce_ratio(ao) and
// multi_bounce_irradiance(ao, albedo) in `language`. Inputs are clamped to 0..1, results finite in 0..1. The
// albedo is RGB: GLSL vec3, HLSL float3, in C++ any struct of x, y, z. The text is free of conditions
// (MIT-0). origin: comment lines for its head, without "// ", that say where the constants come from.
std::string shader_text(const ShaderModel& model, Language language, const std::vector<std::string>& origin);

}  // namespace hemibake
