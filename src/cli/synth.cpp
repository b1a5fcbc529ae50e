#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/options/command.h"
#include "core/constants.h"
#include "core/error.h"
#include "io/image_io.h"
#include "io/output_file.h"
#include "surface/surface.h"
#include "surface/synthetic/synthetic.h"

namespace hemibake {
namespace {

struct SynthOptions {
  std::string kind;
  std::filesystem::path output;
  int width = 512, height = 512;
  uint64_t seed = 1;
  std::optional<double> angle_deg;
};

const SyntheticKindInfo& find_kind(const std::string& name) {
  return *std::ranges::find(synthetic_kinds(), name, &SyntheticKindInfo::name);
}

std::vector<std::string> kind_names() {
  std::vector<std::string> names;
  for (const SyntheticKindInfo& kind : synthetic_kinds()) names.emplace_back(kind.name);
  return names;
}

std::string kinds_help() {
  std::string text = "Kinds:\n";
  for (const SyntheticKindInfo& kind : synthetic_kinds()) {
    text += fmt::format("  {:<10}{}", kind.name, kind.description);
    if (kind.default_angle_deg) text += fmt::format(" [{}]", *kind.default_angle_deg);
    text += '\n';
  }
  return text + "Every map continues without a seam where it repeats.";
}

int run(const SynthOptions& options, const Invocation& invocation) {
  check_output_path(options.output, {".exr", ".png"});
  const SyntheticKindInfo& kind = find_kind(options.kind);
  SyntheticOptions map_options{
      .width = options.width, .height = options.height, .seed = options.seed, .angle_rad = {}};
  if (options.angle_deg) map_options.angle_rad = *options.angle_deg * kPi / 180;

  const SyntheticMap map = synthesize(kind.kind, map_options);
  Provenance provenance = make_provenance(invocation.context.command);
  provenance["recommended_amplitude_m"] = map.recommended_amplitude_m;
  write_height_map(options.output, map.heights, provenance);

  invocation.print(
      {{"output", options.output.string()},
       {"kind", kind.name},
       {"width", options.width},
       {"height", options.height},
       {"seed", options.seed},
       {"recommended_amplitude_m", map.recommended_amplitude_m}},
      fmt::format("{}: {} {}x{}, for a size of 1 m use --amplitude {}\n", options.output.string(), kind.name,
                  options.width, options.height, map.recommended_amplitude_m));
  return 0;
}

}  // namespace

CommandSetup setup_synth() {
  auto options = std::make_shared<SynthOptions>();
  constexpr int kMaxSide = kMaxTexels;
  CommandSetup setup;
  setup.fields = {
      required(option("KIND", choice(options->kind, kind_names()), "what to make, see below")),
      shown_as(required(output_option(options->output, "height map to write: .exr (float) or .png (16 bit)")),
               "MAP"),
      option("width", whole(options->width, 1, kMaxSide),
             fmt::format("texels; width x height at most {}", kMaxTexels)),
      option("height", whole(options->height, 1, kMaxSide), "texels, down the image"),
      option("seed", whole(options->seed, 0),
             "another number, another map (of the materials, bricks to terrain)"),
      option("angle", number(options->angle_deg, kMinSyntheticAngleDeg, kMaxSyntheticAngleDeg),
             "degrees, of bowl and groove; default in brackets below")};
  setup.footer = kinds_help();
  setup.run = [options](const Invocation& invocation) { return run(*options, invocation); };
  return setup;
}

}  // namespace hemibake
