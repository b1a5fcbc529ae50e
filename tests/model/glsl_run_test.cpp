// The exported GLSL, run: a compute shader on whatever OpenGL ES 3.1 the machine has without a window (Mesa's
// software renderer will do), against the library in double, on the grid of shader_cases.h.
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl31.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <vector>

#include "model/shader_cases.h"

namespace hemibake {
namespace {

constexpr const char* kHead = R"(#version 310 es
precision highp float;
layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer Output { vec4 results[]; };
)";

// Returns a shader that writes the three channels of each grid point.
std::string source_of(const ShaderCase& shader) {
  return kHead + shader_text(shader.model, Language::kGlsl, {"a test"}, shader.name) +
         fmt::format(R"(
void main() {{
  uvec3 id = gl_GlobalInvocationID;
  float x = float(id.x) / 32.0, y = float(id.y) / 32.0;
  float albedo = id.z == 15u ? {} : float(id.z) / 16.0;
  vec3 rgb = vec3(albedo, 0.5 * albedo, 1.0);
  results[(id.x * {}u + id.y) * {}u + id.z] = vec4({}, y);
}}
)",
                     kAlmostOne, kInputSteps, kAlbedoSteps, call_of(shader, "vec2(x, y)"));
}

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

// Results of the whole grid, four a point; empty where the shader does not build (the log becomes a failure).
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
  constexpr size_t kFloats = 4 * kGridSize;
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer);
  glBufferData(GL_SHADER_STORAGE_BUFFER, kFloats * sizeof(float), nullptr, GL_STATIC_READ);
  glUseProgram(program);
  glDispatchCompute(kInputSteps, kInputSteps, kAlbedoSteps);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  const auto* mapped = static_cast<const float*>(
      glMapBufferRange(GL_SHADER_STORAGE_BUFFER, 0, kFloats * sizeof(float), GL_MAP_READ_BIT));
  if (!mapped) {
    ADD_FAILURE() << "the results could not be read back";
    return {};
  }
  return {mapped, mapped + kFloats};
}

TEST(GlslRun, EveryModelEqualsTheLibrary) {
  const OffscreenContext context;
  if (!context.ready()) GTEST_SKIP() << "no OpenGL ES 3.1 without a window here";
  for (const ShaderCase& shader : shader_cases()) {
    const std::vector<float> results = run_shader(source_of(shader));
    ASSERT_FALSE(results.empty());
    const double largest = largest_difference(shader.model, results, 4);
    fmt::print("{} {}: largest difference from the library {:.2e}\n",
               reinterpret_cast<const char*>(glGetString(GL_RENDERER)), shader.name, largest);
    EXPECT_LE(largest, tolerance_of(shader.model));
  }
}

}  // namespace
}  // namespace hemibake
