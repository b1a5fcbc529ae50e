#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/command_line.h"
#include "cli/commands.h"
#include "cli/common_options.h"
#include "cli/validators.h"
#include "core/constants.h"
#include "core/error.h"
#include "io/image_io.h"
#include "io/output_file.h"
#include "surface/surface.h"
#include "surface/synthetic/synthetic.h"

namespace hemibake {
namespace {

struct SynthOptions {
  CommonOptions common;
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

int run(const SynthOptions& options) {
  apply_common_options(options.common);
  check_output_path(options.output, {".exr", ".png"});
  const SyntheticKindInfo& kind = find_kind(options.kind);
  SyntheticOptions map_options{
      .width = options.width, .height = options.height, .seed = options.seed, .angle_rad = {}};
  if (options.angle_deg) map_options.angle_rad = *options.angle_deg * kPi / 180;

  const SyntheticMap map = synthesize(kind.kind, map_options);
  Provenance provenance = make_provenance(this_command_line());
  provenance["recommended_amplitude_m"] = map.recommended_amplitude_m;
  write_height_map(options.output, map.heights, provenance);

  print_result(options.common,
               {{"output", options.output.string()},
                {"kind", kind.name},
                {"width", options.width},
                {"height", options.height},
                {"seed", options.seed},
                {"recommended_amplitude_m", map.recommended_amplitude_m}},
               fmt::format("{}: {} {}x{}, for a size of 1 m use --amplitude {}\n", options.output.string(),
                           kind.name, options.width, options.height, map.recommended_amplitude_m));
  return 0;
}

}  // namespace

CommandBody setup_synth(CLI::App& app) {
  auto options = std::make_shared<SynthOptions>();
  constexpr uint64_t kMaxSide = kMaxTexels;
  app.add_option("KIND", options->kind, "what to make, see below")
      ->required()
      ->check(CLI::IsMember(kind_names()));
  app.add_option("-o,--output", options->output, "height map to write: .exr (float) or .png (16 bit)")
      ->required()
      ->option_text("MAP");
  app.add_option("--width", options->width, fmt::format("texels; width x height at most {}", kMaxTexels))
      ->check(whole_number_in(1, kMaxSide))
      ->capture_default_str();
  app.add_option("--height", options->height, "texels, down the image")
      ->check(whole_number_in(1, kMaxSide))
      ->capture_default_str();
  app.add_option("--seed", options->seed, "another number, another map (bricks, shapes, concrete, noise)")
      ->check(whole_number_in(0, std::numeric_limits<uint64_t>::max()))
      ->capture_default_str();
  app.add_option("--angle", options->angle_deg, "degrees, of bowl and groove; default in brackets below")
      ->check(number_in(kMinSyntheticAngleDeg, kMaxSyntheticAngleDeg));
  add_common_options(app, options->common);
  app.footer(kinds_help());
  return [options] { return run(*options); };
}

}  // namespace hemibake
