#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/bake_options.h"
#include "cli/bake_surface.h"
#include "cli/command_line.h"
#include "cli/commands.h"
#include "cli/common_options.h"
#include "cli/print/study.h"
#include "cli/result_folder.h"
#include "cli/validators.h"
#include "io/table_io.h"
#include "trade/study.h"
#include "trade/trade_file.h"

namespace hemibake {
namespace {

struct TradeOptions {
  CommonOptions common;
  BakeOptions bake;
  std::filesystem::path folder;
  std::string effort = "normal";
  double memory_gib = 4;
};

Effort effort_of(const std::string& name) {
  for (const Effort effort : {Effort::kQuick, Effort::kNormal})
    if (name == effort_name(effort)) return effort;
  return Effort::kFull;
}

int run_trade(const CLI::App& app, TradeOptions& options) {
  settle_bake_options(app, options.bake);
  const ResultFolder folder(options.folder);
  for (const char* name : {"trade.json", "trade.csv", "reference.exr", "reference.json"})
    check_bake_output(options.bake, options.folder / name);

  StudyOptions study;
  study.folder = options.folder;
  study.provenance = make_provenance(this_command_line(), options.bake.map);
  record_map_options(options.bake, study.provenance);
  // Runs in the child: this process must not start threads.
  study.load = [&options] {
    apply_common_options(options.common);
    return load_bake_map(options.bake).surface;
  };
  study.reference.effort = effort_of(options.effort);
  study.reference.memory_bytes = static_cast<size_t>(options.memory_gib * 1024 * 1024 * 1024);
  const Study result = run_study(study);

  const nlohmann::ordered_json json =
      json_from_study(result, study.reference.effort, study.provenance, options.folder);
  write_trade_csv(options.folder / "trade.csv", result);
  write_json(options.folder / "trade.json", json);
  const size_t runs = result.runs.size() + 1;
  print_result(options.common, json,
               text_of_study(result) +
                   fmt::format("{0} runs, {1} of them on record from before; `hemibake report {2} -o "
                               "study.html` plots error against time\n",
                               runs, runs - result.made_now, options.folder.string()));
  return 0;
}

}  // namespace

CommandBody setup_trade(CLI::App& app) {
  auto options = std::make_shared<TradeOptions>();
  add_surface_options(app, options->bake);
  app.add_option("-o,--output", options->folder,
                 "folder for trade.json, trade.csv and error maps; made if new. What was done there before, "
                 "with the same map and options, is not done again")
      ->required()
      ->option_text("DIR")
      ->group("Output");
  app.add_option("--effort", options->effort,
                 "how many settings: seconds (quick), minutes (normal) or an hour (full) on 128 x 128 texels")
      ->check(CLI::IsMember({"quick", "normal", "full"}))
      ->capture_default_str()
      ->group("Output");
  app.add_option("--memory", options->memory_gib, "what the links of the reference may take, GiB")
      ->check(positive_to(1e6))
      ->capture_default_str()
      ->group("Output");
  add_common_options(app, options->common);
  return [&app, options] { return run_trade(app, *options); };
}

}  // namespace hemibake
