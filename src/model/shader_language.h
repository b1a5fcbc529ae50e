// Translates functions of a small neutral language into the shading languages and C++.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hemibake {

enum class Language { kGlsl, kHlsl, kWgsl, kMsl, kOsl, kCpp };

// Pairs a constant's name with its value, a number or an expression of the constants before it.
struct ShaderConstant {
  std::string name;
  std::string value;
};

// Holds the parts of a text before translation.
struct ShaderSource {
  std::string head;  // comment lines
  std::string name;  // of the model, for the include guard: "visibility-ao"
  std::vector<ShaderConstant> constants;
  std::string functions;  // in the neutral language below
};

// Writes a finite number with the digits of a float and a decimal point or an exponent.
std::string shader_number(double value);

// Returns the source in `language`, with the constants named once and an include guard where the language has
// a preprocessor.
// prefix: begins every name. Empty: constants and helpers begin with hemibake_, the functions that a caller
// wants with nothing.
//
// The neutral language, line by line: `fn name(a: float, m: vec2, c: vec3) -> vec3 {`, `let x = expression;`
// (a float), `return expression;`, `if (condition) { return expression; }`, comments. In an expression:
// numbers with a decimal point, + - * /, min, max, pow, exp, sqrt, rgb(x, y, z), components .x .y .z. A name
// begins with $ for a constant or a helper, with @ for a function that a caller wants.
std::string translate(const ShaderSource& source, Language language, std::string_view prefix);

}  // namespace hemibake
