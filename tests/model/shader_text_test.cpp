// The exported source, compiled by real compilers. Those that are not installed are skipped with a message.
#include "model/shader_text.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "io/io_testing.h"
#include "support/run_command.h"

namespace hemibake {
namespace {

const BoundedModel kBounded{0.0697, 1, 0.5065, 0.8318};
const GuardedModel kPublished;

bool is_installed(const std::string& program, const TemporaryFolder& folder) {
  return run_command("command -v " + program, folder.path()).exit_code == 0;
}

// Prints as bytes the exported functions of every α and ρ of a grid with both ends.
constexpr const char* kProgram = R"(
#include <cstdio>
#include "model.h"
struct Rgb { float x, y, z; };
int main() {
  using namespace hemibake_model;
  for (int i = 0; i <= 2000; ++i) {
    const float ao = static_cast<float>(i) / 2000.0f;
    for (int j = 0; j <= 200; ++j) {
      const float albedo = static_cast<float>(j) / 200.0f;
      const Rgb rgb = multi_bounce_irradiance(ao, Rgb{albedo, 0.5f * albedo, 2.0f});
      const float row[] = {direct_irradiance(ao), first_bounce_irradiance(ao), bounce_ratio(ao), rgb.x, rgb.y, rgb.z};
      std::fwrite(row, sizeof(float), 6, stdout);
    }
  }
}
)";

// Largest difference of the compiled text from the library in double; 10⁻⁶-grained because a float holds
// 6·10⁻⁸ of 1.
template <class Model>
void expect_equal_to_library(const Model& model) {
  const TemporaryFolder folder;
  if (!is_installed("c++", folder)) GTEST_SKIP() << "no C++ compiler here";
  write_bytes(folder / "model.h", shader_text(model, Language::kCpp, {"a test"}));
  write_bytes(folder / "main.cpp", kProgram);
  const CommandOutcome outcome = run_command(
      fmt::format("cd '{}' && c++ -std=c++11 -O2 -Wall -Wextra -Werror main.cpp -o main && ./main",
                  folder.path().string()),
      folder.path());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  ASSERT_EQ(outcome.out.size(), 2001U * 201U * 6U * sizeof(float));
  std::vector<float> values(2001 * 201 * 6);
  std::memcpy(values.data(), outcome.out.data(), outcome.out.size());
  double largest = 0;
  size_t at = 0;
  for (int i = 0; i <= 2000; ++i) {
    const double ao = static_cast<double>(static_cast<float>(i) / 2000.0F);
    for (int j = 0; j <= 200; ++j) {
      const double albedo = static_cast<double>(static_cast<float>(j) / 200.0F);
      for (const double expected :
           {model.direct(ao), model.first_bounce(ao), model.bounce_ratio(ao), model.total(ao, albedo),
            model.total(ao, 0.5 * albedo), model.total(ao, 1.0)}) {
        const double difference = std::abs(static_cast<double>(values[at++]) - expected);
        largest = difference <= largest ? largest : difference;  // a NaN becomes the largest
      }
    }
  }
  EXPECT_LE(largest, 2e-6);
  fmt::print("largest difference of the compiled float text from the library: {:.2e}\n", largest);
}

TEST(ShaderText, BoundedCppEqualsTheLibrary) { expect_equal_to_library(kBounded); }

TEST(ShaderText, PublishedCppEqualsTheLibrary) { expect_equal_to_library(kPublished); }

TEST(ShaderText, EveryModelCompilesAsGlslAndHlsl) {
  const TemporaryFolder folder;
  if (!is_installed("glslangValidator", folder))
    GTEST_SKIP() << "no glslangValidator here (Debian glslang-tools)";
  const std::string glsl_main =
      "in vec4 v; out vec4 c;\nvoid main() { c = vec4(multi_bounce_irradiance(v.w, v.xyz), bounce_ratio(v.x) "
      "+ first_bounce_irradiance(v.y)); }\n";
  const std::string hlsl_main =
      "float4 main(float4 v : TEXCOORD0) : SV_Target { return float4(multi_bounce_irradiance(v.w, v.xyz), "
      "bounce_ratio(v.x) + first_bounce_irradiance(v.y)); }\n";
  const auto expect_compiles = [&](const auto& model) {
    write_bytes(folder / "desktop.frag",
                "#version 330\n" + shader_text(model, Language::kGlsl, {"a test"}) + glsl_main);
    write_bytes(folder / "es.frag", "#version 300 es\nprecision highp float;\n" +
                                        shader_text(model, Language::kGlsl, {"a test"}) + glsl_main);
    write_bytes(folder / "model.hlsl", shader_text(model, Language::kHlsl, {"a test"}) + hlsl_main);
    for (const std::string arguments : {"desktop.frag", "es.frag", "-D -S frag -e main -V model.hlsl"}) {
      const CommandOutcome outcome = run_command(
          fmt::format("cd '{}' && glslangValidator {}", folder.path().string(), arguments), folder.path());
      EXPECT_EQ(outcome.exit_code, 0) << arguments << "\n" << outcome.out << outcome.err;
      EXPECT_EQ(outcome.out.find("WARNING"), std::string::npos) << outcome.out;
    }
  };
  expect_compiles(kBounded);
  expect_compiles(kPublished);
}

// A fit may bring any constant of either sign: "--" would be another operator.
TEST(ShaderText, NegativeConstantsAreNoOperators) {
  GuardedModel model = kPublished;
  model.formulas.b = -0.815;
  model.formulas.k = -0.25;
  for (const Language language : {Language::kGlsl, Language::kHlsl, Language::kCpp})
    EXPECT_EQ(shader_text(model, language, {}).find("--"), std::string::npos);
}

TEST(ShaderText, OriginStaysInsideItsComments) {
  const std::string text = shader_text(kBounded, Language::kGlsl, {"a\nfloat b;\\", "c"});
  EXPECT_EQ(text.substr(0, text.find("// c\n")), "// a/float b;/\n");
}

// Whoever pastes the text owes nothing, and the text says so itself.
TEST(ShaderText, HeadSaysThatItIsFreeOfConditions) {
  for (const Language language : {Language::kGlsl, Language::kHlsl, Language::kCpp})
    for (const ShaderModel& model : {ShaderModel(kBounded), ShaderModel(kPublished)}) {
      const std::string text = shader_text(model, language, {"a test"});
      EXPECT_EQ(
          text.find(
              "// a test\n// SPDX-License-Identifier: MIT-0. Anyone may use this text without conditions.\n"),
          0U)
          << text;
    }
}

TEST(ShaderText, NothingIsLeftToReplace) {
  for (const Language language : {Language::kGlsl, Language::kHlsl, Language::kCpp}) {
    for (const std::string& text :
         {shader_text(kBounded, language, {}), shader_text(kPublished, language, {})}) {
      EXPECT_EQ(text.find('$'), std::string::npos) << text;
      const std::string code = text.substr(language == Language::kCpp ? text.rfind("#include") + 10 : 0);
      EXPECT_EQ(code.find('#'), std::string::npos) << code;
    }
  }
}

}  // namespace
}  // namespace hemibake
