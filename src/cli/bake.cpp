#include "bake/bake.h"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "bake/record.h"
#include "bake/replay.h"
#include "bake/write.h"
#include "cli/batch.h"
#include "cli/options/bake_options.h"
#include "cli/print/bake.h"
#include "cli/print/map.h"
#include "cli/print/replay.h"
#include "cli/print/textures.h"
#include "cli/print/warnings.h"
#include "cli/result_folder.h"
#include "core/error.h"
#include "core/memory_limit.h"
#include "io/file_context.h"
#include "io/output_check.h"
#include "io/output_file.h"

namespace hemibake {
namespace {

struct BakeCommandOptions : BakeOptions {
  std::vector<std::string> maps;
  std::filesystem::path output;
  std::vector<int> replay;
  bool dry_run = false;

  bool writes() const { return replay.empty() && !dry_run; }
};

void check_outputs(const BakeCommandOptions& options) {
  if (options.output.empty() && !options.map.texel_m.empty())
    throw InputError(
        "--texel is the width of a texel in metres, expected -o BAKE.exr with it; --replay X,Y prints what "
        "one "
        "texel sees");
  if (options.output.empty()) throw InputError("--output: missing, expected -o BAKE.exr");
  if (lower_case_extension(options.output) == ".png")
    throw InputError(fmt::format(
        "{}: a bake is an .exr, or a .tif for other programs, expected one ('hemibake textures' writes "
        ".png files)",
        options.output.string()));
  check_bake_output(options.map, options.output, {".exr", ".tif", ".tiff"});
  if (!options.links.empty()) check_bake_output(options.map, options.links, {".h5", ".hdf5"});
  refuse_overwriting_inputs({options.output, options.links}, {});
}

// Replays a texel or says memory and work, without a bake.
MapOutcome say_beforehand(const BakeCommandOptions& options, const PreparedBake& prepared) {
  if (options.replay.empty()) {
    nlohmann::ordered_json json = json_from_plan(prepared.plan);
    json["map"] = json_from_map(*prepared.map);
    json["warnings"] = warnings_of(*prepared.map);
    return {json, describe_map(*prepared.map) + describe_plan(prepared), "", 0};
  }
  const Replay replay = with_file_context(
      options.map.map, [&] { return replay_texel(prepared, options.replay[0], options.replay[1]); });
  return {json_from_replay(replay), describe_replay(replay), "", 0};
}

// Bakes one map. options: resolved.
MapOutcome bake_one(BakeCommandOptions options, Again again, const Invocation& invocation) {
  if (options.writes()) check_outputs(options);
  options.bake.spill_folder = options.output.parent_path();
  const MemoryScope memory(options.bake.memory_gib,
                           options.writes() ? need_of_bake(options, again, options.output) : MapNeed());
  const LoadedMap map = load_map(options.map, options.bake.normal_length);
  if (again == Again::kSkip && records(options.output, wanted_record(map, options.bake)))
    return skipped(options.map.map, options.output);
  print_warnings(options.map.map.string(), warnings_of(map));
  const PreparedBake prepared = with_file_context(options.map.map, [&] {
    return prepare_bake(map, options.bake,
                        options.writes() ? MemoryLimit::kEnforced : MemoryLimit::kPlannedOnly);
  });
  if (!options.writes()) return say_beforehand(options, prepared);
  const BakeResult result = bake(prepared);
  const Provenance provenance = record_of(map, result, invocation.context.command);
  OutputSet files;
  add_bake_files(result, provenance, options.output, options.links, files);
  files.commit();
  print_warnings(options.map.map.string(), warnings_of(result));
  nlohmann::ordered_json json = json_from_bake(map, result, provenance);
  const std::optional<BounceMapLoss> loss = bounce_map_loss(result.planes);
  json["bounce_map"] = json_from_bounce_map(loss);
  json["output"] = options.output.string();
  return {json, describe_bake(map, result) + describe_bounce_map(loss),
          line_of_bake(options.map, result, options.output), 0};
}

int bake_many(const BakeCommandOptions& options, const Invocation& invocation) {
  refuse_settings_of_one_map(invocation, {"normals", "links", "replay", "dry-run"});
  if (options.output.empty()) throw InputError("--output: missing, expected -o DIR for several maps");
  const std::string extension = lower_case_extension(options.output);
  if (extension == ".exr" || extension == ".tif" || extension == ".tiff")
    throw InputError(
        fmt::format("--output: {} is one file, expected a folder for several maps", options.output.string()));
  const std::vector<std::filesystem::path> maps = find_maps(options.maps);
  const ResultFolder folder(options.output);
  return run_over_maps(maps, invocation, [&](const std::filesystem::path& map) -> MapOutcome {
    BakeCommandOptions of_map = options;
    of_map.map.map = map;
    of_map.output = options.output / (map.stem().string() + ".exr");
    resolve(of_map, invocation);
    return bake_one(of_map, Again::kSkip, invocation);
  });
}

int run_bake(BakeCommandOptions& options, const Invocation& invocation) {
  if (names_many(options.maps)) return bake_many(options, invocation);
  options.map.map = options.maps[0];
  resolve(options, invocation);
  const MapOutcome outcome = bake_one(options, Again::kMake, invocation);
  invocation.print(outcome.json, outcome.text);
  return outcome.exit_code;
}

}  // namespace

CommandSetup setup_bake() {
  auto options = std::make_shared<BakeCommandOptions>();
  CommandSetup setup;
  setup.fields = bake_options(*options);
  take_several_maps(setup.fields, options->maps);
  append(
      setup.fields,
      {in_group(shown_as(output_option(
                             options->output,
                             "the bake to write, EXR, or TIFF for other programs; for several maps a folder"),
                         "BAKE.exr|DIR"),
                "Output"),
       in_group(shown_as(option("replay", whole_numbers(options->replay, 2, 0, int{kMaxTexels - 1}),
                                "print the rays, hits and links of one texel instead, counted from 0"),
                         "X,Y"),
                "Output"),
       in_group(option("dry-run", flag(options->dry_run), "say memory and work, bake nothing"), "Output")});
  setup.run = [options](const Invocation& invocation) { return run_bake(*options, invocation); };
  return setup;
}

}  // namespace hemibake
