// The exported source, compiled by real compilers. Those that are not installed are skipped with a message.
#include "model/shader_text.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <regex>

#include "io/io_testing.h"
#include "model/shader_cases.h"
#include "support/run_command.h"

namespace hemibake {
namespace {

constexpr Language kLanguages[] = {Language::kGlsl, Language::kHlsl, Language::kWgsl,
                                   Language::kMsl,  Language::kOsl,  Language::kCpp};

bool is_installed(const std::string& program, const TemporaryFolder& folder) {
  return run_command("command -v " + program, folder.path()).exit_code == 0;
}

std::string all_texts(Language language) {
  std::string text;
  for (const ShaderCase& shader : shader_cases())
    text += shader_text(shader.model, language, {"a test"}, shader.name);
  return text;
}

// Stand for the parts of shading languages that the texts use, in C++.
constexpr const char* kVectors = R"(
struct float2 { float x, y; float2(float a, float b) : x(a), y(b) {} };
struct float3 { float x, y, z; float3(float a, float b, float c) : x(a), y(b), z(c) {} };
)";
constexpr const char* kFunctions = R"(
inline float min(float a, float b) { return a < b ? a : b; }
inline float max(float a, float b) { return a > b ? a : b; }
using std::pow; using std::exp; using std::sqrt;
)";
constexpr const char* kPutVector = R"(
static void put(const Rgb& c) { const float v[3] = {c.x, c.y, c.z}; std::fwrite(v, sizeof(float), 3, stdout); }
)";
constexpr const char* kPutColor = R"(
static void put(const Rgb& c) { std::fwrite(c.channels, sizeof(float), 3, stdout); }
)";

// Returns a program that prints the results of every case over the grid of shader_cases.h as floats.
std::string program(const std::string& before, const std::string& text, const std::string& after,
                    const std::string& pair) {
  std::string main = "int main() {\n";
  for (const ShaderCase& shader : shader_cases())
    main += fmt::format(R"(
  for (int i = 0; i < {0}; ++i) for (int j = 0; j < {0}; ++j) for (int k = 0; k < {1}; ++k) {{
    const float x = i / 32.0f, y = j / 32.0f, albedo = k == 15 ? {2}f : k / 16.0f;
    const Rgb rgb{{albedo, 0.5f * albedo, 1.0f}};
    (void)y;
    put({3});
  }}
)",
                        kInputSteps, kAlbedoSteps, kAlmostOne, call_of(shader, pair));
  return "#include <cmath>\n#include <cstdio>\n" + before + text + after + main + "}\n";
}

// Compiles, runs and compares with the library in double.
void expect_program_equals_library(const TemporaryFolder& folder, const std::string& source,
                                   const std::string& options, const char* language) {
  write_bytes(folder / "main.cpp", source);
  const CommandOutcome outcome =
      run_command(fmt::format("cd '{}' && c++ -std=c++11 -O1 {} main.cpp -o main && ./main",
                              folder.path().string(), options),
                  folder.path());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::vector<ShaderCase> cases = shader_cases();
  ASSERT_EQ(outcome.out.size(), cases.size() * kGridSize * 3 * sizeof(float));
  std::vector<float> values(cases.size() * kGridSize * 3);
  std::memcpy(values.data(), outcome.out.data(), outcome.out.size());
  for (size_t c = 0; c < cases.size(); ++c) {
    const double largest =
        largest_difference(cases[c].model, std::span(values).subspan(c * kGridSize * 3, kGridSize * 3), 3);
    EXPECT_LE(largest, tolerance_of(cases[c].model)) << language << " " << cases[c].name;
    fmt::print("{} {}: largest difference from the library {:.2e}\n", language, cases[c].name, largest);
  }
}

TEST(ShaderText, CppEqualsTheLibrary) {
  const TemporaryFolder folder;
  if (!is_installed("c++", folder)) GTEST_SKIP() << "no C++ compiler here";
  const std::string before =
      "struct Pair { float x, y; };\nstruct Rgb { float x, y, z; };\n" + std::string(kPutVector);
  expect_program_equals_library(
      folder, program(before, all_texts(Language::kCpp), "using namespace hemibake_model;\n", "Pair{x, y}"),
      "-Wall -Wextra -Werror", "C++");
}

// HLSL, Metal and OSL are close enough to C++ that a few types and functions make a compiler read them: that
// is no proof of the last comma, but of every formula. Metal's and OSL's own compilers are not packaged.
TEST(ShaderText, HlslReadAsCppEqualsTheLibrary) {
  const TemporaryFolder folder;
  if (!is_installed("c++", folder)) GTEST_SKIP() << "no C++ compiler here";
  const std::string before =
      std::string(kVectors) + kFunctions + "using Rgb = float3;\n" + std::string(kPutVector);
  expect_program_equals_library(folder, program(before, all_texts(Language::kHlsl), "", "float2(x, y)"), "",
                                "HLSL");
}

TEST(ShaderText, MetalReadAsCppEqualsTheLibrary) {
  const TemporaryFolder folder;
  if (!is_installed("c++", folder)) GTEST_SKIP() << "no C++ compiler here";
  write_bytes(folder / "metal_stdlib", "#pragma once\n#include <cmath>\nnamespace metal {" +
                                           std::string(kVectors) + kFunctions + "}\n");
  const std::string after = "using Rgb = float3;\n" + std::string(kPutVector);
  expect_program_equals_library(folder, program("", all_texts(Language::kMsl), after, "float2(x, y)"),
                                "-I. '-Dconstant=static const' -Wno-unused", "Metal");
}

TEST(ShaderText, OslReadAsCppEqualsTheLibrary) {
  const TemporaryFolder folder;
  if (!is_installed("c++", folder)) GTEST_SKIP() << "no C++ compiler here";
  const std::string before = R"(
struct color {
  float channels[3];
  color(float a, float b, float c) : channels{a, b, c} {}
  float operator[](int i) const { return channels[i]; }
};
using Rgb = color;
)" + std::string(kFunctions) +
                             kPutColor;
  expect_program_equals_library(folder, program(before, all_texts(Language::kOsl), "", "color(x, y, 0.0f)"),
                                "", "OSL");
}

// Half precision, value by value, in which numbers below the smallest normal one are 0, as GPUs may have it.
constexpr const char* kHalf = R"(
struct Half {
  float v;
  Half(double x) : v(static_cast<float>(static_cast<_Float16>(x))) { if (std::fabs(v) < 6.1035e-5f) v = 0; }
  Half operator-() const { return Half(-v); }
};
inline Half operator+(Half a, Half b) { return Half(double(a.v) + b.v); }
inline Half operator-(Half a, Half b) { return Half(double(a.v) - b.v); }
inline Half operator*(Half a, Half b) { return Half(double(a.v) * b.v); }
inline Half operator/(Half a, Half b) { return Half(double(a.v) / b.v); }
inline bool operator<(Half a, Half b) { return a.v < b.v; }
inline bool operator<=(Half a, Half b) { return a.v <= b.v; }
inline bool operator>=(Half a, Half b) { return a.v >= b.v; }
inline Half min(Half a, Half b) { return a.v < b.v ? a : b; }
inline Half max(Half a, Half b) { return a.v > b.v ? a : b; }
inline Half pow(Half a, Half b) { return Half(std::pow(double(a.v), double(b.v))); }
inline Half exp(Half a) { return Half(std::exp(double(a.v))); }
inline Half sqrt(Half a) { return Half(std::sqrt(double(a.v))); }
struct float2 { Half x, y; };
struct float3 { Half x, y, z; float3(Half a, Half b, Half c) : x(a), y(b), z(c) {} };
using Rgb = float3;
static void put(const Rgb& c) {
  const float v[3] = {c.x.v, c.y.v, c.z.v};
  std::fwrite(v, sizeof(float), 3, stdout);
}
#define float Half
)";

// Constants far below half's smallest number, or 1 − ρ that vanishes, must not make 0/0.
TEST(ShaderText, HalfPrecisionIsFiniteAndInRange) {
  const TemporaryFolder folder;
  write_bytes(folder / "half.cpp", "int main() { return static_cast<int>(static_cast<_Float16>(0)); }\n");
  const std::string compile = fmt::format("cd '{}' && c++ -std=c++11 -O1 ", folder.path().string());
  if (run_command(compile + "half.cpp -o half", folder.path()).exit_code != 0)
    GTEST_SKIP() << "no C++ compiler with half precision here";
  write_bytes(folder / "main.cpp",
              program(kHalf, all_texts(Language::kHlsl), "#undef float\n", "float2{x, y}"));
  const CommandOutcome outcome = run_command(compile + "main.cpp -o main && ./main", folder.path());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::vector<ShaderCase> cases = shader_cases();
  std::vector<float> values(cases.size() * kGridSize * 3);
  ASSERT_EQ(outcome.out.size(), values.size() * sizeof(float));
  std::memcpy(values.data(), outcome.out.data(), outcome.out.size());
  constexpr float kUnit = 0x1p-9F;  // two units in the last place of 1
  for (size_t i = 0; i < values.size(); ++i) {
    const std::string& name = cases[i / (kGridSize * 3)].name;
    EXPECT_TRUE(values[i] >= 0 && values[i] <= 1 + kUnit) << name << " " << values[i];
    const bool white = i % 3 == 2 && name != "cubic_";  // the third channel has albedo 1
    EXPECT_GE(values[i], white ? 1 - kUnit : 0) << name;
  }
}

// Prints as bytes the functions of α that tell bounces apart.
constexpr const char* kParts = R"(
#include <cstdio>
#include "model.h"
int main() {
  using namespace hemibake_model;
  for (int i = 0; i <= 2000; ++i) {
    const float ao = static_cast<float>(i) / 2000.0f;
    const float row[] = {direct_irradiance(ao), first_bounce_irradiance(ao), bounce_ratio(ao)};
    std::fwrite(row, sizeof(float), 3, stdout);
  }
}
)";

template <class Model>
void expect_parts_equal_library(const Model& model) {
  const TemporaryFolder folder;
  if (!is_installed("c++", folder)) GTEST_SKIP() << "no C++ compiler here";
  write_bytes(folder / "model.h", shader_text(model, Language::kCpp, {"a test"}));
  write_bytes(folder / "main.cpp", kParts);
  const CommandOutcome outcome = run_command(
      fmt::format("cd '{}' && c++ -std=c++11 -O2 -Wall -Wextra -Werror main.cpp -o main && ./main",
                  folder.path().string()),
      folder.path());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  std::vector<float> values(2001 * 3);
  ASSERT_EQ(outcome.out.size(), values.size() * sizeof(float));
  std::memcpy(values.data(), outcome.out.data(), outcome.out.size());
  double largest = 0;
  for (size_t i = 0; i <= 2000; ++i) {
    const double ao = static_cast<double>(static_cast<float>(i) / 2000.0F);
    const double expected[] = {model.direct(ao), model.first_bounce(ao), model.bounce_ratio(ao)};
    for (size_t c = 0; c < 3; ++c) {
      const double difference = std::abs(static_cast<double>(values[i * 3 + c]) - expected[c]);
      largest = difference <= largest ? largest : difference;
    }
  }
  EXPECT_LE(largest, 2e-6);
}

TEST(ShaderText, PartsOfTheBoundedModelEqualTheLibrary) {
  expect_parts_equal_library(BoundedModel{0.0697, 1, 0.5065, 0.8318});
}
TEST(ShaderText, PartsOfThePublishedModelEqualTheLibrary) { expect_parts_equal_library(GuardedModel{}); }

TEST(ShaderText, EveryModelCompilesAsGlslAndHlsl) {
  const TemporaryFolder folder;
  if (!is_installed("glslangValidator", folder))
    GTEST_SKIP() << "no glslangValidator here (Debian glslang-tools)";
  for (const ShaderCase& shader : shader_cases()) {
    const auto main_of = [&](const char* pair, const char* open, const char* close) {
      return fmt::format("{} float x = v.w, y = v.x; {} rgb = v.xyz; {}{}, 1.0); }}\n", open,
                         std::string(pair) == "vec2(x, y)" ? "vec3" : "float3", close, call_of(shader, pair));
    };
    const std::string glsl = shader_text(shader.model, Language::kGlsl, {"a test"}, shader.name) +
                             main_of("vec2(x, y)", "in vec4 v; out vec4 c;\nvoid main() {", "c = vec4(");
    const std::string hlsl =
        shader_text(shader.model, Language::kHlsl, {"a test"}, shader.name) +
        main_of("float2(x, y)", "float4 main(float4 v : TEXCOORD0) : SV_Target {", "return float4(");
    write_bytes(folder / "desktop.frag", "#version 330\n" + glsl);
    write_bytes(folder / "es.frag", "#version 300 es\nprecision highp float;\n" + glsl);
    write_bytes(folder / "model.hlsl", hlsl);
    for (const std::string arguments : {"desktop.frag", "es.frag", "-D -S frag -e main -V model.hlsl"}) {
      const CommandOutcome outcome = run_command(
          fmt::format("cd '{}' && glslangValidator {}", folder.path().string(), arguments), folder.path());
      EXPECT_EQ(outcome.exit_code, 0) << arguments << "\n" << outcome.out << outcome.err;
      EXPECT_EQ(outcome.out.find("WARNING"), std::string::npos) << outcome.out;
    }
  }
}

// Returns the text without comments and constants.
std::string functions_of(const std::string& text) {
  return std::regex_replace(text, std::regex("//[^\n]*|const float[^\n]*"), "");
}

size_t count(const std::string& text, const std::string& part) {
  size_t n = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

// Every division stands in the function of a channel, but for the one of g in two of the models.
TEST(ShaderText, OneReciprocalAChannelAndNoPower) {
  for (const ShaderCase& shader : shader_cases()) {
    if (std::holds_alternative<GuardedModel>(shader.model)) continue;
    const std::string text = functions_of(shader_text(shader.model, Language::kGlsl, {}));
    const bool another = std::holds_alternative<BoundedModel>(shader.model) ||
                         std::holds_alternative<MeanEscapeModel>(shader.model);
    const bool cubic = std::holds_alternative<JimenezModel>(shader.model);
    EXPECT_EQ(count(text, "/"), another ? 2U : cubic ? 0U : 1U) << text;
    EXPECT_EQ(count(text, cubic ? "hemibake_cubic(" : "hemibake_all_bounces("), 4U) << text;
    for (const char* costly : {"pow(", "exp(", "sqrt("}) EXPECT_EQ(count(text, costly), 0U) << text;
  }
}

TEST(ShaderText, ConstantsAreNamedOnce) {
  const std::string text = shader_text(VisibilityModel{0.03125, 0.828125}, Language::kHlsl, {});
  EXPECT_EQ(count(text, "0.03125"), 1U);
  EXPECT_EQ(count(text, "0.828125"), 1U);
  EXPECT_NE(text.find("static const float hemibake_dark = 0.03125;\n"), std::string::npos) << text;
}

// A prefix begins every name that the text declares; without one only what a caller wants has none.
TEST(ShaderText, PrefixBeginsEveryName) {
  const std::regex declared("(?:^|\n)(?:float|vec3|const float) (\\w+)");
  for (const ShaderCase& shader : shader_cases()) {
    const std::string text = shader_text(shader.model, Language::kGlsl, {}, "my_");
    EXPECT_EQ(text.find("hemibake_"), std::string::npos) << text;
    EXPECT_NE(text.find("#ifndef MY_"), std::string::npos);
    for (std::sregex_iterator at(text.begin(), text.end(), declared), end; at != end; ++at)
      EXPECT_EQ((*at)[1].str().substr(0, 3), "my_") << at->str();
  }
}

TEST(ShaderText, ArgumentsSayWhichAoTheyAre) {
  for (const Language language : kLanguages) {
    const std::string one = shader_text(VisibilityModel{}, language, {});
    const std::string two = shader_text(VisibilityAoModel{}, language, {});
    EXPECT_EQ(one.find("ao_uniform"), std::string::npos);
    EXPECT_NE(one.find("// visibility: "), std::string::npos);
    EXPECT_NE(two.find("// ao_uniform: "), std::string::npos);
    EXPECT_NE(two.find("wapped"), std::string::npos);
    EXPECT_NE(two.find("multi_bounce_irradiance("), std::string::npos);
  }
}

// A fit may bring any constant of either sign: "--" would be another operator.
TEST(ShaderText, NegativeConstantsAreNoOperators) {
  GuardedModel model;
  model.formulas.b = -0.815;
  model.formulas.k = -0.25;
  for (const Language language : kLanguages)
    EXPECT_EQ(shader_text(model, language, {}).find("--"), std::string::npos);
}

TEST(ShaderText, OriginStaysInsideItsComments) {
  const std::string text = shader_text(BoundedModel{}, Language::kGlsl, {"a\nfloat b;\\", "c"});
  EXPECT_EQ(text.substr(0, text.find("// c\n")), "// a/float b;/\n");
}

// Whoever pastes the text owes nothing, and the text says so itself.
TEST(ShaderText, HeadSaysThatItIsFreeOfConditions) {
  for (const Language language : kLanguages)
    for (const ShaderCase& shader : shader_cases()) {
      const std::string text = shader_text(shader.model, language, {"a test"});
      EXPECT_EQ(
          text.find(
              "// a test\n// SPDX-License-Identifier: MIT-0. Anyone may use this text without conditions.\n"),
          0U)
          << text;
    }
}

TEST(ShaderText, IncludingTwiceIsHarmless) {
  for (const Language language : kLanguages) {
    const std::string text = shader_text(VisibilityModel{}, language, {});
    const bool guarded = text.find("#ifndef HEMIBAKE_VISIBILITY_") != std::string::npos;
    EXPECT_EQ(guarded, language != Language::kWgsl);  // has no preprocessor
  }
}

TEST(ShaderText, NothingIsLeftToReplace) {
  for (const Language language : kLanguages)
    for (const ShaderCase& shader : shader_cases()) {
      const std::string text = shader_text(shader.model, language, {});
      EXPECT_EQ(text.find_first_of("$@"), std::string::npos) << text;
      EXPECT_EQ(text.find("#escape"), std::string::npos) << text;
      EXPECT_EQ(text.find("let ") == std::string::npos, language != Language::kWgsl) << text;
    }
}

}  // namespace
}  // namespace hemibake
