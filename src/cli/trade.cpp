#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "bake/record.h"
#include "cli/options/bake_options.h"
#include "cli/print/study.h"
#include "cli/result_folder.h"
#include "core/error.h"
#include "core/memory_limit.h"
#include "io/file_set.h"
#include "io/output_check.h"
#include "io/output_file.h"
#include "io/table_io.h"
#include "trade/study.h"
#include "trade/trade_file.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

struct TradeOptions {
  MapSettings map;
  std::filesystem::path folder;
  std::string effort = "normal";
  double memory_gib = 4;
};

Effort effort_of(const std::string& name) {
  for (const Effort effort : {Effort::kQuick, Effort::kNormal})
    if (name == effort_name(effort)) return effort;
  return Effort::kFull;
}

// Refuses a map in the folders that a study fills.
void check_folder(const TradeOptions& options) {
  std::vector<fs::path> outputs;
  for (const char* name : {"trade.json", "trade.csv", "reference.exr", "reference.json"}) {
    outputs.push_back(options.folder / name);
    check_bake_output(options.map, outputs.back());
  }
  refuse_overwriting_inputs(outputs, {});
  for (const fs::path& input : {options.map.map, options.map.normal_map})
    for (const char* name : {"runs", "planes", "errors"}) {
      std::error_code not_there;
      if (!input.empty() &&
          fs::equivalent(fs::absolute(input, not_there).parent_path(), options.folder / name, not_there))
        throw InputError(fmt::format(
            "{}: is in a folder that the study fills, expected another folder for either", input.string()));
    }
}

// Loads the map for a child process, whose errors come back as text: they name options here already.
Surface load_surface(const TradeOptions& options) {
  const MemoryScope memory(options.memory_gib);
  try {
    Surface surface = load_map(options.map).surface;
    if (!surface.holes.empty())
      throw SettingError("has open holes, which only rays know, expected {holes} fill for a study",
                         options.map.map.string());
    return surface;
  } catch (const SettingError& error) {
    throw InputError(error.with_prefix("--"));
  }
}

// Writes the table and its record, which names it.
void write_results(const fs::path& folder, const Study& study, nlohmann::ordered_json json) {
  OutputSet files;
  OutputFile& record = files.add(folder / "trade.json");
  OutputFile& table = files.add(folder / "trade.csv");
  write_trade_csv(table, study);
  json["files"] = hashes_of({&table});
  // Adds what the study wrote on its way, and another one in the folder may have begun to replace.
  std::vector<std::string> names = {"reference.exr"};
  for (const nlohmann::ordered_json& picture : json["pictures"]) names.push_back(picture["file"]);
  for (const std::string& name : names) json["files"][name] = sha256_of_file(folder / name);
  write_json(record, json);
  files.commit();
}

int run_trade(TradeOptions& options, const Invocation& invocation) {
  BakeSettings unused;
  resolve_defaults(options.map, unused, invocation.given);
  validate(options.map, unused, invocation.given);
  const ResultFolder folder(options.folder);
  check_folder(options);

  StudyOptions study;
  study.folder = options.folder;
  study.provenance = make_provenance(invocation.context.command);
  record_map(options.map, hash_files(options.map), study.provenance);
  // Runs in the child: this process must not start threads.
  study.load = [&options] { return load_surface(options); };
  study.reference.effort = effort_of(options.effort);
  study.reference.memory_bytes = static_cast<size_t>(options.memory_gib * 1024 * 1024 * 1024);
  const Study result = run_study(study);

  const nlohmann::ordered_json json =
      json_from_study(result, study.reference.effort, study.provenance, options.folder);
  write_results(options.folder, result, json);
  const size_t runs = result.runs.size() + 1;
  invocation.print(json, text_of_study(result) +
                             fmt::format("{0} runs, {1} of them on record from before; `hemibake report {2}` "
                                         "plots error against time\n",
                                         runs, runs - result.made_now, options.folder.string()));
  return 0;
}

}  // namespace

CommandSetup setup_trade() {
  auto options = std::make_shared<TradeOptions>();
  CommandSetup setup;
  setup.fields = surface_options(options->map);
  append(setup.fields,
         {in_group(shown_as(required(output_option(
                                options->folder,
                                "folder for trade.json, trade.csv and error maps; made if new. What was done "
                                "there before, with the same map and options, is not done again")),
                            "DIR"),
                   "Output"),
          in_group(option("effort", choice(options->effort, {"quick", "normal", "full"}),
                          "how many settings: seconds (quick), minutes (normal) or an hour (full) on 128 x "
                          "128 texels"),
                   "Output"),
          in_group(option("memory", positive(options->memory_gib, 1e6),
                          "what the links of the reference may take, GiB"),
                   "Output")});
  setup.run = [options](const Invocation& invocation) { return run_trade(*options, invocation); };
  return setup;
}

}  // namespace hemibake
