#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "cli/bake_job.h"
#include "cli/commands.h"
#include "cli/common_options.h"
#include "cli/replay.h"
#include "cli/validators.h"
#include "core/error.h"
#include "io/bake_file.h"
#include "surface/surface.h"

namespace hemibake {
namespace {

struct BakeCommandOptions {
  CommonOptions common;
  BakeOptions bake;
  std::string output;
  std::vector<int> texel;
  bool dry_run = false;
};

int run_bake(const CLI::App& app, BakeCommandOptions& options) {
  apply_common_options(options.common);
  settle_bake_options(app, options.bake);
  const bool writes = options.texel.empty() && !options.dry_run;
  if (writes && options.output.empty()) throw InputError("--output: missing, expected -o BAKE.exr");
  if (writes) check_bake_output(options.bake, options.output, {".exr"});
  if (writes && !options.bake.links.empty())
    check_bake_output(options.bake, options.bake.links, {".h5", ".hdf5"});

  BakeJob job;
  job.spill_folder = std::filesystem::path(options.output).parent_path();
  prepare_bake(options.bake, !writes, job);
  if (!options.texel.empty()) {
    const Replay replay = replay_texel(job, options.texel[0], options.texel[1]);
    print_result(options.common, json_from_replay(replay), describe_replay(replay));
    return 0;
  }
  if (options.dry_run) {
    print_result(options.common, json_from_plan(job), describe_plan(job));
    return 0;
  }
  const BakeResult result = perform_bake(job);
  write_bake(options.output, result.bake, result.provenance);
  for (const std::string& warning : result.warnings)
    fmt::print(stderr, "hemibake: {}: warning: {}\n", options.bake.map.string(), warning);
  print_result(options.common, json_from_bake(job, result), describe_bake(job, result));
  return 0;
}

}  // namespace

CommandBody setup_bake(CLI::App& app) {
  auto options = std::make_shared<BakeCommandOptions>();
  add_bake_options(app, options->bake);
  app.add_option("-o,--output", options->output, "the bake to write, EXR")
      ->option_text("BAKE.exr")
      ->group("Output");
  app.add_option("--texel", options->texel,
                 "print the rays, hits and links of one texel instead, counted from 0")
      ->check(whole_number_in(0, kMaxTexels - 1))
      ->delimiter(',')
      ->expected(2)
      ->option_text("X,Y")
      ->group("Output");
  app.add_flag("--dry-run", options->dry_run, "say memory and work, bake nothing")->group("Output");
  add_common_options(app, options->common);
  return [&app, options] { return run_bake(app, *options); };
}

}  // namespace hemibake
