// The exported GLSL, run: a compute shader on whatever OpenGL ES 3.1 the machine has without a window (Mesa's
// software renderer will do), against the library in double.
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl31.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "model/shader_text.h"

namespace hemibake {
namespace {

constexpr int kSteps = 512;  // per axis: α along x, ρ along y

constexpr const char* kHead = R"(#version 310 es
precision highp float;
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) buffer Output { vec4 results[]; };
)";

// Both ends of α and ρ are among the inputs.
constexpr const char* kMain = R"(
void main() {
  float ao = float(gl_GlobalInvocationID.x) / 511.0;
  float albedo = float(gl_GlobalInvocationID.y) / 511.0;
  vec3 rgb = multi_bounce_irradiance(ao, vec3(albedo, 0.5 * albedo, 1.0));
  results[gl_GlobalInvocationID.y * 512u + gl_GlobalInvocationID.x] = vec4(rgb.xy, direct_irradiance(ao), bounce_ratio(ao));
}
)";

// An OpenGL ES context without a window, gone with the object.
class OffscreenContext {
 public:
  OffscreenContext() {
    const auto get_display =
        reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
    if (!get_display) return;
    display_ = get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display_ == EGL_NO_DISPLAY || !eglInitialize(display_, nullptr, nullptr)) return;
    const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
    EGLConfig config;
    EGLint count = 0;
    if (!eglChooseConfig(display_, wanted, &config, 1, &count) || count == 0) return;
    eglBindAPI(EGL_OPENGL_ES_API);
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 1, EGL_NONE};
    context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, version);
    ready_ = context_ != EGL_NO_CONTEXT && eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
  }
  ~OffscreenContext() {
    if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
    if (display_ != EGL_NO_DISPLAY) eglTerminate(display_);
  }
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

  bool ready() const { return ready_; }

 private:
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
  bool ready_ = false;
};

// Results of the whole grid, four a pixel; empty where the shader does not build (the log becomes a failure).
std::vector<float> run_shader(const std::string& source) {
  const char* text = source.c_str();
  const GLuint program = glCreateShaderProgramv(GL_COMPUTE_SHADER, 1, &text);
  GLint linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (!linked) {
    char log[4096] = "";
    glGetProgramInfoLog(program, sizeof log, nullptr, log);
    ADD_FAILURE() << log;
    return {};
  }
  constexpr size_t kFloats = size_t{4} * kSteps * kSteps;
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer);
  glBufferData(GL_SHADER_STORAGE_BUFFER, kFloats * sizeof(float), nullptr, GL_STATIC_READ);
  glUseProgram(program);
  glDispatchCompute(kSteps / 8, kSteps / 8, 1);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  const auto* mapped = static_cast<const float*>(
      glMapBufferRange(GL_SHADER_STORAGE_BUFFER, 0, kFloats * sizeof(float), GL_MAP_READ_BIT));
  if (!mapped) {
    ADD_FAILURE() << "the results could not be read back";
    return {};
  }
  return {mapped, mapped + kFloats};
}

template <class Model>
void expect_equal_to_library(const Model& model) {
  const OffscreenContext context;
  if (!context.ready()) GTEST_SKIP() << "no OpenGL ES 3.1 without a window here";
  const std::vector<float> results =
      run_shader(kHead + shader_text(model, Language::kGlsl, {"a test"}) + kMain);
  ASSERT_FALSE(results.empty());
  double largest = 0;
  size_t at = 0;
  for (int y = 0; y < kSteps; ++y) {
    for (int x = 0; x < kSteps; ++x) {
      const double ao = static_cast<double>(static_cast<float>(x) / 511.0F);
      const double albedo = static_cast<double>(static_cast<float>(y) / 511.0F);
      for (const double expected : {model.total(ao, albedo), model.total(ao, 0.5 * albedo), model.direct(ao),
                                    model.bounce_ratio(ao)}) {
        const double difference = std::abs(static_cast<double>(results[at++]) - expected);
        largest = difference <= largest ? largest : difference;  // a NaN becomes the largest
      }
    }
  }
  fmt::print("{}: largest difference from the library: {:.2e}\n",
             reinterpret_cast<const char*>(glGetString(GL_RENDERER)), largest);
  // GLSL divides to 2.5 units in the last place and its pow is good to about 16: some 10⁻⁶.
  EXPECT_LE(largest, 5e-6);
}

TEST(GlslRun, BoundedModelEqualsTheLibrary) {
  expect_equal_to_library(BoundedModel{0.0697, 1, 0.5065, 0.8318});
}
TEST(GlslRun, PublishedModelEqualsTheLibrary) { expect_equal_to_library(GuardedModel{}); }

}  // namespace
}  // namespace hemibake
