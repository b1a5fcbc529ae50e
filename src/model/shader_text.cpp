#include "model/shader_text.h"

#include <fmt/format.h>

#include <type_traits>

namespace hemibake {
namespace {

constexpr std::string_view kLicence =
    "// SPDX-License-Identifier: MIT-0. Anyone may use this text without conditions.\n";

constexpr std::string_view kResults =
    R"(// Results: irradiance relative to that of an open surface, 0..1; multiply by the irradiance that the environment
// gives without occlusion, and by the albedo for the light that leaves. albedo: linear, 0..1.
)";

constexpr std::string_view kAoUsage =
    R"(// ao: ambient occlusion as the visible share of the hemisphere, every direction counting the same (not
// cosine-weighted), 0..1. The cosine-weighted AO of GTAO, Substance or Unreal in its place is mostly larger, by up to
// .25: cavities come out too bright.
)";

constexpr std::string_view kVisibilityUsage =
    R"(// visibility: ambient occlusion, cosine-weighted, 0..1, 1 = open: what GTAO, Substance, Unreal and the sky-view factor
// mean by AO. The uniform share of visible directions in its place is mostly smaller, by up to .25: all but flat ground
// comes out too dark, at albedo 0 already.
)";

constexpr std::string_view kAoUniformUsage =
    R"(// ao_uniform: the same with every direction counting the same, 0..1; hemibake calls it ao. It says how well light
// between the walls escapes, visibility how much arrives at once. ao_uniform * ao_uniform <= visibility <= ao_uniform *
// (2 - ao_uniform); swapped, the result is wrong by up to .25, mostly too dark.
)";

constexpr std::string_view kNormalUsage =
    R"(// normal_z: z of the shading normal in the frame of the large surface, 0..1: 2 * blue - 1 of a tangent-space normal map.
// At the same visibility light leaves walls more easily than floors.
)";

constexpr std::string_view kMeanEscapeUsage =
    R"(// The constant mean_escape is one number of a map, from its visibility alone: (mean(v) - mean(v * v)) / (1 - mean(v)).
)";

constexpr std::string_view kMapUsage =
    R"(// map: two ordinary ambient occlusion textures in two channels, linear, filtered as usual. x: visibility, the
// cosine-weighted AO: all light at albedo 0. y: all light at the albedo that is named below as bounce_albedo; it must be
// the one that the map was baked with. y is never below x. Swapped, every albedo below 1 gets the light of that one.
)";

constexpr std::string_view kUnitRange = R"(
fn $unit_range(x: float) -> float {
  return min(max(x, 0.0), 1.0);
}
)";

constexpr std::string_view kBounded = R"(
// F0: the light straight from the sky. Between ao * ao and ao * (2 - ao).
fn @direct_irradiance(ao: float) -> float {
  let a = $unit_range(ao);
  return a * (1.0 + (1.0 - a) * ($k0 + ($k1 - $k0) * a * a));
}

// 1 - F0, without cancellation near ao = 1.
fn $blocked_irradiance(ao: float) -> float {
  let a = $unit_range(ao);
  let b = 1.0 - a;
  return b * (b + a * (1.0 - $k1 + ($k1 - $k0) * b * (1.0 + a)));
}

// 1 - tau: the share of the light between the walls that each bounce sends out to the sky.
fn $escape_share(ao: float) -> float {
  let direct = @direct_irradiance(ao);
  return $escape_dark + ($escape_open - $escape_dark) * (4.0 * direct / (1.0 + 3.0 * direct));
}
)";

constexpr std::string_view kGuarded = R"(
// F0: the light straight from the sky. The formula exceeds 1 close to ao = 1, hence the cut.
fn @direct_irradiance(ao: float) -> float {
  let a = $unit_range(ao);
  return $unit_range(a * (1.0 + $k * pow(1.0 - a, $e)));
}

// 1 - F0.
fn $blocked_irradiance(ao: float) -> float {
  return 1.0 - @direct_irradiance(ao);
}

// 1 - tau = F1 / (1 - F0), cut at 1 where the formulas' F1 exceeds 1 - F0 (from about ao = 0.76 on).
fn $escape_share(ao: float) -> float {
  let a = $unit_range(ao);
  let b = 1.0 - a;
  let first = $a * a * b * sqrt(b) * exp($minus_b * sqrt(sqrt(a)));
  let blocked = $blocked_irradiance(ao);
  if (first < blocked) {
    return first / blocked;
  }
  return 1.0;
}
)";

constexpr std::string_view kOfAo = R"(
// F1: the light of the first bounce, at albedo 1.
fn @first_bounce_irradiance(ao: float) -> float {
  return $blocked_irradiance(ao) * $escape_share(ao);
}

// tau: each further bounce over the one before, at albedo 1.
fn @bounce_ratio(ao: float) -> float {
  return 1.0 - $escape_share(ao);
}

// F0 + albedo * F1 / (1 - albedo * tau), written so that no difference of near equals is divided by.
fn $all_bounces(direct: float, blocked: float, escape: float, albedo: float) -> float {
  let r = $unit_range(albedo);
  if (r >= 1.0) {
    return 1.0;
  }
  let sent_out = r * escape;
  return min(direct + blocked * (sent_out / (1.0 - r + sent_out)), 1.0);
}

// All bounces of light, for each channel of the albedo.
fn @multi_bounce_irradiance(ao: float, albedo: vec3) -> vec3 {
  let direct = @direct_irradiance(ao);
  let blocked = $blocked_irradiance(ao);
  let escape = $escape_share(ao);
  return rgb(
      $all_bounces(direct, blocked, escape, albedo.x),
      $all_bounces(direct, blocked, escape, albedo.y),
      $all_bounces(direct, blocked, escape, albedo.z));
}
)";

constexpr std::string_view kAllBounces = R"(
// 1 - blocked * (1 - albedo) / (1 - albedo + albedo * escape): visibility at albedo 0, 1 at albedo 1.
// escape: the chance that light which leaves the surface leaves for the sky.
fn $all_bounces(blocked: float, escape: float, albedo: float) -> float {
  let r = $unit_range(albedo);
  let kept = 1.0 - r;
  if (kept <= 0.0) {
    return 1.0;
  }
  return 1.0 - blocked * (kept / (kept + r * escape));
}
)";

constexpr std::string_view kOfVisibility = R"(
// All bounces of light, for each channel of the albedo.
fn @multi_bounce_irradiance(visibility: float, albedo: vec3) -> vec3 {
  let v = $unit_range(visibility);
  let blocked = 1.0 - v;
  let escape = #escape;
)";

constexpr std::string_view kOfVisibilityAndAo = R"(
// All bounces of light, for each channel of the albedo. The order is visibility, then ao_uniform.
fn @multi_bounce_irradiance(visibility: float, ao_uniform: float, albedo: vec3) -> vec3 {
  let blocked = 1.0 - $unit_range(visibility);
  let a = $unit_range(ao_uniform);
  let escape = #escape;
)";

constexpr std::string_view kOfVisibilityAndNormal = R"(
// All bounces of light, for each channel of the albedo. The order is visibility, then normal_z.
fn @multi_bounce_irradiance(visibility: float, normal_z: float, albedo: vec3) -> vec3 {
  let v = $unit_range(visibility);
  let blocked = 1.0 - v;
  let escape = min(v * ($steep_escape - $escape_fall * $unit_range(normal_z)), 1.0);
)";

// Ends each of the three functions above.
constexpr std::string_view kEachChannel = R"(  return rgb(
      $all_bounces(blocked, escape, albedo.x),
      $all_bounces(blocked, escape, albedo.y),
      $all_bounces(blocked, escape, albedo.z));
}
)";

constexpr std::string_view kOfBounceMap = R"(
// The curve through visibility at albedo 0, the map's second number at its albedo, and 1 at albedo 1.
// blocked: 1 - visibility. missing: what is missing of 1 at the map's albedo. gained: how much bounces filled in.
fn $all_bounces(blocked: float, missing: float, gained: float, albedo: float) -> float {
  let r = $unit_range(albedo);
  if (r >= 1.0) {
    return 1.0;
  }
  let kept = (1.0 - r) * missing;
  let sum = kept + r * gained;
  if (sum <= 0.0) {
    return 1.0 - blocked;
  }
  return 1.0 - blocked * (kept / sum);
}

// All bounces of light, for each channel of the albedo.
fn @multi_bounce(map: vec2, albedo: vec3) -> vec3 {
  let blocked = 1.0 - $unit_range(map.x);
  let missing = min($unit_range(1.0 - map.y), blocked);
  let gained = $bounce_odds * (blocked - missing);
  return rgb(
      $all_bounces(blocked, missing, gained, albedo.x),
      $all_bounces(blocked, missing, gained, albedo.y),
      $all_bounces(blocked, missing, gained, albedo.z));
}
)";

constexpr std::string_view kBounceAlbedo = R"(
// The albedo to pass above where it varies over the surface: bounces bring the colour of the neighbourhood. blurred: the
// albedo texture at the mip level log2(height range in texels). own: the albedo here. The result above is irradiance: it
// is still multiplied by the albedo here, not by this one.
fn @albedo_of_bounces(blurred: vec3, own: vec3) -> vec3 {
  return rgb(
      blurred.x + $own_share * (own.x - blurred.x),
      blurred.y + $own_share * (own.y - blurred.y),
      blurred.z + $own_share * (own.z - blurred.z));
}
)";

constexpr std::string_view kJimenez = R"(
// The cubic of Jimenez et al. 2016 for one channel, never below visibility.
fn $cubic(v: float, albedo: float) -> float {
  let r = $unit_range(albedo);
  let a = $p0 * r + $p1;
  let b = $p2 * r + $p3;
  let c = $p4 * r + $p5;
  return max(v, ((a * v + b) * v + c) * v);
}

// All bounces of light, for each channel of the albedo.
fn @multi_bounce_irradiance(visibility: float, albedo: vec3) -> vec3 {
  let v = $unit_range(visibility);
  return rgb(
      $cubic(v, albedo.x),
      $cubic(v, albedo.y),
      $cubic(v, albedo.z));
}
)";

// Share of a texel's own albedo in what its bounces meet (fits/README.md).
const ShaderConstant kOwnShare{"$own_share", "0.25"};

ShaderConstant number(const char* name, double value) { return {name, shader_number(value)}; }

// Returns dark + (open − dark)·variable; the variable alone where that is all.
std::string linear_escape(std::string_view variable, double dark, double open) {
  if (dark == 0 && open == 1) return std::string(variable);
  return fmt::format("$dark + ($open - $dark) * {}", variable);
}

std::string with_escape(std::string_view functions, std::string_view escape) {
  std::string text(functions);
  return text.replace(text.find("#escape"), 7, escape);
}

std::vector<ShaderConstant> escape_constants(double dark, double open) {
  if (dark == 0 && open == 1) return {kOwnShare};
  return {number("$dark", dark), number("$open", open), kOwnShare};
}

std::string join(std::initializer_list<std::string_view> parts) {
  std::string text;
  for (const std::string_view part : parts) text += part;
  return text;
}

ShaderSource source_of(const BoundedModel& m) {
  return {join({kAoUsage, kResults}),
          "bounded",
          {number("$k0", m.k0), number("$k1", m.k1), number("$escape_dark", m.q * (1 - m.d)),
           number("$escape_open", m.q)},
          join({kUnitRange, kBounded, kOfAo})};
}

ShaderSource source_of(const GuardedModel& model) {
  const Mayaux2018Model& m = model.formulas;
  return {
      join({kAoUsage, kResults}),
      "published",
      {number("$k", m.k), number("$e", m.e), number("$a", m.a), number("$minus_b", -m.b)},
      join({kUnitRange, kGuarded, kOfAo}),
  };
}

// Returns the parts that the models with an escape share have in common. function: begins the one of all
// bounces.
std::string escape_functions(std::string_view function) {
  return join({kUnitRange, kAllBounces, function, kEachChannel, kBounceAlbedo});
}

ShaderSource source_of(const VisibilityModel& m) {
  return {join({kVisibilityUsage, kResults}), "visibility", escape_constants(m.dark, m.open),
          escape_functions(with_escape(kOfVisibility, linear_escape("v", m.dark, m.open)))};
}

ShaderSource source_of(const VisibilityNormalModel&) {
  return {join({kVisibilityUsage, kNormalUsage, kResults}),
          "visibility-normal",
          {number("$steep_escape", kSteepEscape), number("$escape_fall", kEscapeFall), kOwnShare},
          escape_functions(kOfVisibilityAndNormal)};
}

ShaderSource source_of(const VisibilityAoModel& m) {
  return {join({kVisibilityUsage, kAoUniformUsage, kResults}), "visibility-ao",
          escape_constants(m.dark, m.open),
          escape_functions(with_escape(kOfVisibilityAndAo, linear_escape("a", m.dark, m.open)))};
}

ShaderSource source_of(const MeanEscapeModel& m) {
  return {join({kVisibilityUsage, kAoUniformUsage, kMeanEscapeUsage, kResults}),
          "visibility-ao-mean",
          {number("$mean_escape", m.mean_escape), kOwnShare},
          escape_functions(with_escape(kOfVisibilityAndAo, "a * (1.0 + $mean_escape) / (1.0 + a)"))};
}

ShaderSource source_of(const BounceMapModel& m) {
  return {join({kMapUsage, kResults}),
          "bounce-map",
          {number("$bounce_albedo", m.bounce_albedo),
           {"$bounce_odds", "(1.0 - $bounce_albedo) / $bounce_albedo"},
           kOwnShare},
          join({kUnitRange, kOfBounceMap, kBounceAlbedo})};
}

ShaderSource source_of(const JimenezModel& m) {
  ShaderSource source{join({kVisibilityUsage, kResults}), "jimenez", {}, join({kUnitRange, kJimenez})};
  for (size_t i = 0; i < m.parameters.size(); ++i)
    source.constants.push_back({fmt::format("$p{}", i), shader_number(m.parameters[i])});
  return source;
}

// One comment, whatever the line holds: names of files and commands may bring line ends, and a backslash at
// the end would join the next line to it.
std::string comment_line(std::string line) {
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < ' ' || c == '\\') c = '/';
  }
  return fmt::format("// {}\n", line);
}

}  // namespace

std::string shader_text(const AnyModel& model, Language language, const std::vector<std::string>& origin,
                        std::string_view prefix) {
  ShaderSource source = std::visit([](const auto& m) { return source_of(m); }, model);
  std::string head;
  for (const std::string& line : origin) head += comment_line(line);
  source.head = head + std::string(kLicence) + "//\n" + source.head;
  return translate(source, language, prefix);
}

}  // namespace hemibake
