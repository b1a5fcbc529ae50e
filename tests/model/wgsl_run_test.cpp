// The exported WGSL, compiled and run by a browser (Chromium: Tint on a software Vulkan), against the
// library.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "io/io_testing.h"
#include "model/shader_cases.h"
#include "support/run_command.h"

namespace hemibake {
namespace {

constexpr const char* kBrowser =
    "timeout 120 chromium --headless --no-sandbox --enable-unsafe-webgpu --enable-features=Vulkan "
    "--use-vulkan=swiftshader --use-webgpu-adapter=swiftshader --virtual-time-budget=100000 --dump-dom";

// Runs every shader of `sources` and leaves its floats in the page as hexadecimal digits.
constexpr const char* kPage = R"(<!doctype html><body><script>
async function run(device, code, bytes) {
  const module = device.createShaderModule({ code });
  const messages = (await module.getCompilationInfo()).messages;
  if (messages.length) throw messages.map((m) => m.message).join('; ');
  const pipeline = device.createComputePipeline({ layout: 'auto', compute: { module, entryPoint: 'main' } });
  const out = device.createBuffer({ size: bytes, usage: GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_SRC });
  const read = device.createBuffer({ size: bytes, usage: GPUBufferUsage.COPY_DST | GPUBufferUsage.MAP_READ });
  const group = device.createBindGroup({ layout: pipeline.getBindGroupLayout(0),
    entries: [{ binding: 0, resource: { buffer: out } }] });
  const encoder = device.createCommandEncoder();
  const pass = encoder.beginComputePass();
  pass.setPipeline(pipeline);
  pass.setBindGroup(0, group);
  pass.dispatchWorkgroups(INPUTS, INPUTS, ALBEDOS);
  pass.end();
  encoder.copyBufferToBuffer(out, 0, read, 0, bytes);
  device.queue.submit([encoder.finish()]);
  await read.mapAsync(GPUMapMode.READ);
  return [...new Uint8Array(read.getMappedRange())].map((b) => b.toString(16).padStart(2, '0')).join('');
}
// The browser prints the page when its virtual time is over: burns real time until the results are there.
let finished = false, sink = 0;
function wait() {
  for (let i = 0; i < 3e6; ++i) sink += i;
  if (!finished) setTimeout(wait, 10);
}
wait();
(async () => {
  let text = '';
  try {
    const adapter = navigator.gpu && await navigator.gpu.requestAdapter();
    if (!adapter) throw 'no adapter';
    const device = await adapter.requestDevice();
    for (const code of SOURCES) text += await run(device, code, BYTES);
    text = 'done ' + text;
  } catch (error) {
    text = 'failed: ' + error;
  }
  document.body.textContent = '[' + text + ']';
  finished = true;
})();
</script>)";

std::string source_of(const ShaderCase& shader) {
  return shader_text(shader.model, Language::kWgsl, {"a test"}, shader.name) +
         fmt::format(R"(
@group(0) @binding(0) var<storage, read_write> results: array<vec4f>;
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {{
  let x = f32(id.x) / 32.0;
  let y = f32(id.y) / 32.0;
  let albedo = select(f32(id.z) / 16.0, {}, id.z == 15u);
  let rgb = vec3f(albedo, 0.5 * albedo, 1.0);
  results[(id.x * {}u + id.y) * {}u + id.z] = vec4f({}, y);
}}
)",
                     kAlmostOne, kInputSteps, kAlbedoSteps, call_of(shader, "vec2f(x, y)"));
}

void replace(std::string& text, const std::string& from, const std::string& to) {
  for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

std::string page() {
  std::string text = kPage, sources = "[";
  replace(text, "INPUTS", std::to_string(kInputSteps));
  replace(text, "ALBEDOS", std::to_string(kAlbedoSteps));
  replace(text, "BYTES", std::to_string(kGridSize * 4 * sizeof(float)));
  for (const ShaderCase& shader : shader_cases()) sources += "`" + source_of(shader) + "`,\n";
  replace(text, "SOURCES", sources + "]");
  return text;
}

TEST(WgslRun, EveryModelEqualsTheLibrary) {
  const TemporaryFolder folder;
  if (run_command("command -v chromium", folder.path()).exit_code != 0) GTEST_SKIP() << "no Chromium here";
  write_bytes(folder / "page.html", page());
  const CommandOutcome outcome =
      run_command(fmt::format("{} 'file://{}'", kBrowser, (folder / "page.html").string()), folder.path());
  const size_t begin = outcome.out.find("<body>["), end = outcome.out.find(']', begin);
  if (begin == std::string::npos) GTEST_SKIP() << "Chromium gave no page here";
  const std::string result = outcome.out.substr(begin + 7, end - begin - 7);
  if (result == "failed: no adapter") GTEST_SKIP() << "Chromium has no WebGPU here";
  ASSERT_EQ(result.substr(0, 5), "done ") << result.substr(0, 2000);

  const std::vector<ShaderCase> cases = shader_cases();
  std::vector<float> values(kGridSize * 4 * cases.size());
  ASSERT_EQ(result.size(), 5 + values.size() * sizeof(float) * 2);
  std::vector<unsigned char> bytes(values.size() * sizeof(float));
  for (size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = static_cast<unsigned char>(std::stoi(result.substr(5 + 2 * i, 2), nullptr, 16));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  for (size_t c = 0; c < cases.size(); ++c) {
    const double largest =
        largest_difference(cases[c].model, std::span(values).subspan(c * kGridSize * 4, kGridSize * 4), 4);
    fmt::print("WGSL {}: largest difference from the library {:.2e}\n", cases[c].name, largest);
    EXPECT_LE(largest, tolerance_of(cases[c].model)) << cases[c].name;
  }
}

}  // namespace
}  // namespace hemibake
