#include "bake/bake.h"

#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "bake/record.h"
#include "bake/replay.h"
#include "bake/write.h"
#include "cli/options/bake_options.h"
#include "cli/print/bake.h"
#include "cli/print/replay.h"
#include "cli/print/warnings.h"
#include "core/error.h"
#include "io/file_context.h"
#include "io/output_file.h"

namespace hemibake {
namespace {

struct BakeCommandOptions : BakeOptions {
  std::filesystem::path output;
  std::vector<int> texel;
  bool dry_run = false;

  bool writes() const { return texel.empty() && !dry_run; }
};

void check_outputs(const BakeCommandOptions& options) {
  if (options.output.empty()) throw InputError("--output: missing, expected -o BAKE.exr");
  const std::string extension = lower_case_extension(options.output);
  if (extension == ".png" || extension == ".tif" || extension == ".tiff")
    throw InputError(fmt::format("{}: a bake is an .exr, expected one ('hemibake textures' writes {} files)",
                                 options.output.string(), extension));
  check_bake_output(options.map, options.output, {".exr"});
  if (!options.links.empty()) check_bake_output(options.map, options.links, {".h5", ".hdf5"});
}

int run_bake(BakeCommandOptions& options, const Invocation& invocation) {
  resolve(options, invocation);
  if (options.writes()) check_outputs(options);
  options.bake.spill_folder = options.output.parent_path();
  const LoadedMap map = load_map(options.map, options.bake.normal_length);
  const PreparedBake prepared = with_file_context(options.map.map, [&] {
    return prepare_bake(map, options.bake,
                        options.writes() ? MemoryLimit::kEnforced : MemoryLimit::kPlannedOnly);
  });
  if (!options.texel.empty()) {
    const Replay replay = with_file_context(
        options.map.map, [&] { return replay_texel(prepared, options.texel[0], options.texel[1]); });
    invocation.print(json_from_replay(replay), describe_replay(replay));
    return 0;
  }
  if (options.dry_run) {
    invocation.print(json_from_plan(prepared.plan), describe_plan(prepared));
    return 0;
  }
  const BakeResult result = bake(prepared);
  const Provenance provenance = record_of(options.map, map, result, invocation.context.command);
  write_results(result, provenance, options.output, options.links);
  print_warnings(options.map.map.string(), warnings_of(result));
  invocation.print(json_from_bake(result, provenance), describe_bake(options, result));
  return 0;
}

}  // namespace

CommandSetup setup_bake() {
  auto options = std::make_shared<BakeCommandOptions>();
  CommandSetup setup;
  setup.fields = bake_options(*options);
  append(
      setup.fields,
      {in_group(shown_as(output_option(options->output, "the bake to write, EXR"), "BAKE.exr"), "Output"),
       in_group(shown_as(option("texel", whole_numbers(options->texel, 2, 0, int{kMaxTexels - 1}),
                                "print the rays, hits and links of one texel instead, counted from 0"),
                         "X,Y"),
                "Output"),
       in_group(option("dry-run", flag(options->dry_run), "say memory and work, bake nothing"), "Output")});
  setup.run = [options](const Invocation& invocation) { return run_bake(*options, invocation); };
  return setup;
}

}  // namespace hemibake
