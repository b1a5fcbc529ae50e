#include "model/shader_language.h"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <sstream>
#include <stdexcept>

namespace hemibake {
namespace {

// Holds what differs between the languages. In `constant`, {0} is the name and {1} the value.
struct Spelling {
  std::string_view name;                            // in the include guard
  std::string_view open;                            // after the guard's first lines
  std::string_view close;                           // before its last
  std::string_view constant;                        // declares one
  std::string_view function;                        // before each function without templates
  std::array<std::string_view, 3> types;            // of float, vec2, vec3 as results
  std::array<std::string_view, 3> parameter_types;  // and as parameters
  std::string_view rgb_open, rgb_close;             // around three numbers
  std::string_view number_suffix;
  std::string_view library;  // prefix of min, max, pow, exp, sqrt
  bool preprocessor = true;
};

constexpr std::array<std::string_view, 3> kGlslTypes{"float", "vec2", "vec3"};
constexpr std::array<std::string_view, 3> kHlslTypes{"float", "float2", "float3"};
constexpr std::array<std::string_view, 3> kWgslTypes{"f32", "vec2f", "vec3f"};
// OSL has no pairs: a pair is the first two channels of a colour.
constexpr std::array<std::string_view, 3> kOslTypes{"float", "color", "color"};
constexpr std::array<std::string_view, 3> kCppTypes{"float", "Vec2", "Vec3"};
constexpr std::array<std::string_view, 3> kCppParameterTypes{"float", "const Vec2&", "const Vec3&"};

constexpr Spelling kGlsl{
    "GLSL", "", "", "const float {0} = {1};", "", kGlslTypes, kGlslTypes, "vec3(", ")", "", "",
};
constexpr Spelling kHlsl{
    "HLSL", "", "", "static const float {0} = {1};", "", kHlslTypes, kHlslTypes, "float3(", ")", "", "",
};
constexpr Spelling kWgsl{
    "WGSL", "", "", "const {0}: f32 = {1};", "fn ", kWgslTypes, kWgslTypes, "vec3f(", ")", "", "", false,
};
constexpr Spelling kMsl{"MSL",      "#include <metal_stdlib>\nusing namespace metal;\n\n",
                        "",         "constant float {0} = {1};",
                        "inline ",  kHlslTypes,
                        kHlslTypes, "float3(",
                        ")",        "f",
                        ""};
constexpr Spelling kOsl{
    "OSL", "", "", "#define {0} ({1})", "", kOslTypes, kOslTypes, "color(", ")", "", "",
};
constexpr Spelling kCpp{"CPP",
                        "#include <algorithm>\n#include <cmath>\n\nnamespace hemibake_model {\n\n",
                        "\n}  // namespace hemibake_model\n",
                        "constexpr float {0} = {1};",
                        "inline ",
                        kCppTypes,
                        kCppParameterTypes,
                        "Vec3{",
                        "}",
                        "f",
                        "std::"};

const Spelling& spelling(Language language) {
  switch (language) {
    case Language::kGlsl:
      return kGlsl;
    case Language::kHlsl:
      return kHlsl;
    case Language::kWgsl:
      return kWgsl;
    case Language::kMsl:
      return kMsl;
    case Language::kOsl:
      return kOsl;
    case Language::kCpp:
      return kCpp;
  }
  throw std::logic_error("an unknown shader language");
}

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

// Translates expressions and signatures of one text.
class Translator {
 public:
  Translator(Language language, std::string_view prefix)
      : language_(language),
        spelling_(spelling(language)),
        helper_prefix_(prefix.empty() ? "hemibake_" : prefix),
        function_prefix_(prefix) {}

  // Replaces names, numbers, components and calls, word by word.
  std::string expression(std::string_view text) const {
    std::string result;
    for (size_t at = 0; at < text.size();) {
      size_t end = at + 1;
      if (text[at] == '$' || text[at] == '@' || text[at] == '.' || is_word(text[at])) {
        const bool number = std::isdigit(static_cast<unsigned char>(text[at]));
        while (end < text.size() && (is_word(text[end]) || (number && continues_number(text, end)))) ++end;
        result += word(text.substr(at, end - at));
      } else {
        result += text[at];
      }
      at = end;
    }
    return result;
  }

  // Translates `fn name(a: float) -> float {`.
  std::string signature(std::string_view line) const {
    const size_t open = line.find('('), close = line.find(')');
    const std::string name = expression(line.substr(3, open - 3));
    const std::string_view list = line.substr(open + 1, close - open - 1);
    const size_t arrow = line.find("-> ") + 3;
    const std::string_view result = line.substr(arrow, line.find(' ', arrow) - arrow);
    if (language_ == Language::kWgsl)
      return fmt::format("fn {}({}) -> {} {{", name, parameters(list), type(result, spelling_.types));
    return fmt::format("{}{} {}({}) {{", before_function(list), type(result, spelling_.types), name,
                       parameters(list));
  }

  std::string line(std::string_view text) const {
    const size_t indent = std::min(text.find_first_not_of(' '), text.size());
    const std::string_view body = text.substr(indent);
    const std::string spaces(text.substr(0, indent));
    if (body.starts_with("//")) return std::string(text);
    if (body.starts_with("fn ")) return spaces + signature(body);
    if (body.starts_with("let ") && language_ != Language::kWgsl)
      return spaces + "float " + expression(body.substr(4));
    return spaces + expression(body);
  }

  std::string constant(const ShaderConstant& constant) const {
    return fmt::format(fmt::runtime(spelling_.constant), expression(constant.name),
                       expression(constant.value));
  }

  std::string guard(std::string_view model) const {
    std::string name = fmt::format("{}{}_{}", helper_prefix_, model, spelling_.name);
    for (char& c : name)
      c = is_word(c) ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : '_';
    return name;
  }

 private:
  static bool continues_number(std::string_view text, size_t at) {
    return text[at] == '.' || ((text[at] == '-' || text[at] == '+') && text[at - 1] == 'e');
  }

  std::string word(std::string_view word) const {
    if (word[0] == '$') return helper_prefix_ + std::string(word.substr(1));
    if (word[0] == '@') return function_prefix_ + std::string(word.substr(1));
    if (std::isdigit(static_cast<unsigned char>(word[0])))
      return std::string(word) + std::string(spelling_.number_suffix);
    if (language_ == Language::kOsl && word.size() == 2 && word[0] == '.' && word[1] >= 'x' && word[1] <= 'z')
      return fmt::format("[{}]", word[1] - 'x');
    for (const std::string_view function : {"min", "max", "pow", "exp", "sqrt"})
      if (word == function) return std::string(spelling_.library) + std::string(word);
    return std::string(word);
  }

  static std::string type(std::string_view name, const std::array<std::string_view, 3>& types) {
    return std::string(types[name == "float" ? 0 : name == "vec2" ? 1 : 2]);
  }

  std::string before_function(std::string_view list) const {
    const bool pair = list.find("vec2") != list.npos, triple = list.find("vec3") != list.npos;
    if (language_ != Language::kCpp || (!pair && !triple)) return std::string(spelling_.function);
    return fmt::format("template <{}class Vec3>\n", pair ? "class Vec2, " : "");
  }

  std::string parameters(std::string_view list) const {
    std::string result;
    while (!list.empty()) {
      const size_t colon = list.find(": "), comma = std::min(list.find(", "), list.size());
      const std::string_view name = list.substr(0, colon);
      const std::string kind = type(list.substr(colon + 2, comma - colon - 2), spelling_.parameter_types);
      if (!result.empty()) result += ", ";
      result +=
          language_ == Language::kWgsl ? fmt::format("{}: {}", name, kind) : fmt::format("{} {}", kind, name);
      list = list.substr(std::min(comma + 2, list.size()));
    }
    return result;
  }

  Language language_;
  const Spelling& spelling_;
  std::string helper_prefix_, function_prefix_;
};

// Replaces rgb( and its closing bracket, which ends its statement.
std::string with_colors(std::string text, const Spelling& s) {
  for (size_t at = text.find("rgb("); at != std::string::npos; at = text.find("rgb(", at)) {
    const size_t end = text.find(");", at);
    text.replace(end, 1, s.rgb_close);
    text.replace(at, 4, s.rgb_open);
    at += s.rgb_open.size();
  }
  return text;
}

}  // namespace

std::string shader_number(double value) {
  std::string text = fmt::format("{:.9g}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string translate(const ShaderSource& source, Language language, std::string_view prefix) {
  const Spelling& s = spelling(language);
  const Translator translator(language, prefix);
  std::string body;
  for (const ShaderConstant& constant : source.constants) body += translator.constant(constant) + "\n";
  std::istringstream lines(with_colors(source.functions, s));
  for (std::string line; std::getline(lines, line);) body += translator.line(line) + "\n";
  body = std::string(s.open) + body + std::string(s.close);
  if (!s.preprocessor) return source.head + "\n" + body;
  const std::string guard = translator.guard(source.name);
  return fmt::format("{0}\n#ifndef {1}\n#define {1}\n\n{2}\n#endif  // {1}\n", source.head, guard, body);
}

}  // namespace hemibake
