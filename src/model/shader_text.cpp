#include "model/shader_text.h"

#include <fmt/format.h>

#include <stdexcept>
#include <string_view>

namespace hemibake {
namespace {

// Holds the parts of the text that differ between the three languages.
struct Spelling {
  std::string_view open;             // before the functions
  std::string_view close;            // after them
  std::string_view function;         // before each function
  std::string_view vector_function;  // before one that takes or gives a vector
  std::string_view vector;           // type of a colour
  std::string_view vector_argument;
  std::string_view vector_open, vector_close;  // around three numbers
  std::string_view number_suffix;
  std::string_view prefix;  // of min, max, pow, exp, sqrt
};

constexpr Spelling kGlsl{"", "", "", "", "vec3", "vec3", "vec3(", ")", "", ""};
constexpr Spelling kHlsl{"", "", "", "", "float3", "float3", "float3(", ")", "", ""};
constexpr Spelling kCpp{
    "#pragma once\n\n#include <algorithm>\n#include <cmath>\n\nnamespace hemibake_model {\n\n",
    "\n}  // namespace hemibake_model\n",
    "inline ",
    "template <class Vec3>\n",
    "Vec3",
    "const Vec3&",
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
    case Language::kCpp:
      return kCpp;
  }
  throw std::logic_error("an unknown shader language");
}

// Writes a float with all its digits and a decimal point.
std::string literal(double value, const Spelling& s) {
  std::string text = fmt::format("{:.9g}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text + std::string(s.number_suffix);
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

constexpr std::string_view kUsage =
    R"(// SPDX-License-Identifier: MIT-0. Anyone may use this text without conditions.
//
// ao: ambient occlusion as the visible share of the hemisphere, every direction counting the same (not
// cosine-weighted), 0..1. albedo: linear, 0..1. Results: irradiance relative to that of an open surface, 0..1; multiply
// by the irradiance that the environment gives without occlusion.
)";

// $x is replaced as Spelling says; #0, #1, … by numbers.
constexpr std::string_view kSafe = R"(
$function float unit_range(float x) {
  return $min($max(x, #0), #1);
}
)";

constexpr std::string_view kBounded = R"(
// F0: the light straight from the sky. Between ao * ao and ao * (2 - ao).
$function float direct_irradiance(float ao) {
  float a = unit_range(ao);
  return a * (#1 + (#1 - a) * ($dark + $rise * a * a));
}

// 1 - F0, without cancellation near ao = 1.
$function float blocked_irradiance(float ao) {
  float a = unit_range(ao);
  return (#1 - a) * (#1 - a * ($dark + $rise * a * a));
}

// 1 - tau: the share of the light between the walls that each bounce sends out to the sky.
$function float escape_share(float ao) {
  return $q * (#1 - $d * blocked_irradiance(ao) / (#1 + #3 * direct_irradiance(ao)));
}
)";

constexpr std::string_view kGuarded = R"(
// F0: the light straight from the sky. The formula exceeds 1 close to ao = 1, hence the cut.
$function float direct_irradiance(float ao) {
  float a = unit_range(ao);
  return unit_range(a * (#1 + $k * $pow(#1 - a, $e)));
}

// 1 - F0.
$function float blocked_irradiance(float ao) {
  return #1 - direct_irradiance(ao);
}

// 1 - tau = F1 / (1 - F0), cut at 1 where the formulas' F1 exceeds 1 - F0 (from about ao = 0.76 on), and just above 0.
$function float escape_share(float ao) {
  float a = unit_range(ao);
  float b = #1 - a;
  float first = $a * a * b * $sqrt(b) * $exp($negative_b * $sqrt($sqrt(a)));
  float blocked = blocked_irradiance(ao);
  return first < blocked ? $max(first / blocked, #tiny) : #1;
}
)";

constexpr std::string_view kCommon = R"(
// F1: the light of the first bounce, at albedo 1.
$function float first_bounce_irradiance(float ao) {
  return blocked_irradiance(ao) * escape_share(ao);
}

// tau: each further bounce over the one before, at albedo 1.
$function float bounce_ratio(float ao) {
  return #1 - escape_share(ao);
}

// F0 + albedo * F1 / (1 - albedo * tau), written so that no difference of near equals is divided by.
$function float all_bounces(float direct, float blocked, float escape, float albedo) {
  float r = unit_range(albedo);
  float sent_out = r * escape;
  return $min(direct + blocked * (sent_out / (#1 - r + sent_out)), #1);
}

// All bounces of light, for each channel of the albedo.
$vector_function$vector multi_bounce_irradiance(float ao, $vector_argument albedo) {
  float direct = direct_irradiance(ao);
  float blocked = blocked_irradiance(ao);
  float escape = escape_share(ao);
  return $vector_open
      all_bounces(direct, blocked, escape, albedo.x),
      all_bounces(direct, blocked, escape, albedo.y),
      all_bounces(direct, blocked, escape, albedo.z)$vector_close;
}
)";

// One comment, whatever the line holds: names of files and commands may bring line ends, and a backslash at
// the end would join the next line to it.
std::string comment_line(std::string line) {
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < ' ' || c == '\\') c = '/';
  }
  return fmt::format("// {}\n", line);
}

using Constants = std::vector<std::pair<std::string_view, double>>;

std::string assemble(std::string_view model, const Constants& constants, Language language,
                     const std::vector<std::string>& origin) {
  const Spelling& s = spelling(language);
  std::string body = std::string(kSafe) + std::string(model) + std::string(kCommon);
  // Longer names before their beginnings.
  for (const auto& [name, text] : std::initializer_list<std::pair<std::string_view, std::string_view>>{
           {"$vector_function", s.vector_function},
           {"$vector_argument", s.vector_argument},
           {"$vector_open", s.vector_open},
           {"$vector_close", s.vector_close},
           {"$vector", s.vector},
           {"$function ", s.function}}) {
    replace_all(body, name, text);
  }
  for (const std::string_view name : {"min", "max", "pow", "exp", "sqrt"}) {
    replace_all(body, fmt::format("${}(", name), fmt::format("{}{}(", s.prefix, name));
  }
  for (const auto& [name, value] : constants) replace_all(body, name, literal(value, s));
  replace_all(body, "#0", literal(0, s));
  replace_all(body, "#1", literal(1, s));
  replace_all(body, "#3", literal(3, s));

  std::string head;
  for (const std::string& line : origin) head += comment_line(line);
  return head + std::string(kUsage) + std::string(s.open) + body.substr(s.open.empty() ? 0 : 1) +
         std::string(s.close);
}

}  // namespace

std::string shader_text(const ShaderModel& model, Language language, const std::vector<std::string>& origin) {
  if (const BoundedModel* m = std::get_if<BoundedModel>(&model))
    return assemble(kBounded, {{"$dark", m->k0}, {"$rise", m->k1 - m->k0}, {"$q", m->q}, {"$d", m->d}},
                    language, origin);
  const Mayaux2018Model& m = std::get<GuardedModel>(model).formulas;
  return assemble(kGuarded,
                  {{"$k", m.k}, {"$e", m.e}, {"$a", m.a}, {"$negative_b", -m.b}, {"#tiny", kSmallestEscape}},
                  language, origin);
}

}  // namespace hemibake
