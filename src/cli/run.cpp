#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "bake/bake.h"
#include "bake/record.h"
#include "bake/write.h"
#include "cli/batch.h"
#include "cli/file_checks.h"
#include "cli/options/bake_options.h"
#include "cli/print/bake.h"
#include "cli/print/checks.h"
#include "cli/print/fits.h"
#include "cli/print/map.h"
#include "cli/print/streams.h"
#include "cli/print/textures.h"
#include "cli/print/warnings.h"
#include "cli/result_folder.h"
#include "core/context.h"
#include "core/error.h"
#include "core/memory_limit.h"
#include "curves/curves.h"
#include "fitting/models.h"
#include "io/bake_file.h"
#include "io/curves_file.h"
#include "io/file_context.h"
#include "io/file_set.h"
#include "io/fit_file.h"
#include "io/output_check.h"
#include "io/output_file.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

// Names the other files of a run with their hashes.
constexpr const char* kRecord = "check.json";

struct RunOptions : BakeOptions {
  std::vector<std::string> maps;
  fs::path folder;
  int bins = 100;
};

// name: of the map.
FitFile fit_all(const std::string& name, const Curves& curves, const Provenance& provenance) {
  const std::vector<MapCurves> maps = {{name, curves}};
  MapFits fits = fit_maps(default_fit_models(curves.index), maps, Abscissa::kCenter, Weights::kNone);
  return {std::move(fits.fits), provenance, std::move(fits.comparison)};
}

std::string describe_fits(const FitFile& file) {
  return text_from_fits(file.fits) + text_from_comparison(file.comparison, file.fits);
}

// A map may have too few AO values for a fit (flat ground has one): that is said, and leaves the rest whole.
std::optional<FitFile> fits_of(const Curves& curves, const RunOptions& options,
                               const Provenance& provenance) {
  try {
    return fit_all(options.map.map.stem().string(), curves, provenance);
  } catch (const std::runtime_error& error) {
    throw_if_cancelled();
    print_message(fmt::format("{}: no fit: {}", options.map.map.string(), error.what()));
    return std::nullopt;
  }
}

// Holds what a run found, besides the bake.
struct RunResults {
  Curves curves;
  Checks checks;
  std::optional<FitFile> fits;
};

// Writes all files before the first gets its name. The record comes first: a run that is killed between two
// names leaves one that other files do not match.
void write_run(const RunOptions& options, const BakeResult& bake, const Provenance& provenance,
               const RunResults& results) {
  OutputSet files;
  OutputFile& record = files.add(options.folder / kRecord);
  std::vector<OutputFile*> named = {
      &add_bake_files(bake, provenance, options.folder / "bake.exr", options.links, files)};
  named.push_back(&files.add(options.folder / "curves.csv"));
  write_curves(*named.back(), results.curves);
  if (results.fits) {
    named.push_back(&files.add(options.folder / "fit.json"));
    write_fits(*named.back(), *results.fits);
  }
  nlohmann::ordered_json json = json_from_checks(results.checks);
  json["files"] = hashes_of(named);
  write_json(record, json);
  files.commit();
  // The fit.json of an earlier run would pass for this one's.
  std::error_code not_there;
  if (!results.fits) fs::remove(options.folder / "fit.json", not_there);
}

void check_outputs(const RunOptions& options) {
  if (!options.bake.wants(BakeOutput::kAo) || !options.bake.wants(BakeOutput::kIrradiance))
    throw InputError("--outputs: curves need ao and irradiance, expected both among them");
  std::vector<fs::path> outputs = {options.links};
  for (const char* name : {"bake.exr", "curves.csv", "fit.json", kRecord}) {
    outputs.push_back(options.folder / name);
    check_bake_output(options.map, outputs.back());
  }
  if (!options.links.empty()) check_bake_output(options.map, options.links, {".h5", ".hdf5"});
  refuse_overwriting_inputs(outputs, {});
}

// Returns whether the results of an earlier run are there and those of this one would be the same.
bool was_run(const RunOptions& options, const LoadedMap& map) {
  const FileSetState state = file_set_state(options.folder / kRecord);
  return state.is_recorded && state.changed.empty() && state.missing.empty() &&
         records(options.folder / "bake.exr", wanted_record(map, options.bake));
}

// Does it all for one map. options: resolved.
MapOutcome run_one(RunOptions options, Again again, const Invocation& invocation) {
  const ResultFolder folder(options.folder);
  check_outputs(options);

  options.bake.spill_folder = options.folder;
  const MemoryScope memory(options.bake.memory_gib,
                           need_of_bake(options, again, options.folder / "bake.exr"));
  const LoadedMap map = load_map(options.map, options.bake.normal_length);
  if (again == Again::kSkip && was_run(options, map)) return skipped(options.map.map, options.folder);
  print_warnings(options.map.map.string(), warnings_of(map));
  const BakeResult result =
      with_file_context(options.map.map, [&] { return bake(map, options.bake, invocation.context); });
  const Provenance provenance = record_of(map, result, invocation.context.command);
  RunResults results{
      make_curves(result.planes, options.bins), checks_of_bake({result.planes, provenance}, {}), {}};
  results.fits = fits_of(results.curves, options, provenance);
  write_run(options, result, provenance, results);
  print_warnings(options.map.map.string(), warnings_of(result));
  if (results.fits) print_warnings(options.map.map.string(), fit_warnings(results.fits->fits));

  const std::optional<FitFile>& fits = results.fits;
  const Checks& checks = results.checks;
  nlohmann::ordered_json json = json_from_bake(map, result, provenance);
  const std::optional<BounceMapLoss> loss = bounce_map_loss(result.planes);
  json["bounce_map"] = json_from_bounce_map(loss);
  json["fits"] = nullptr;
  if (fits) {
    json["fits"] = json_from_fits(*fits);
    json["fits"].erase("provenance");
  }
  json["check"] = json_from_checks(checks);
  json["output"] = options.folder.string();
  return {json,
          describe_bake(map, result) + describe_bounce_map(loss) + (fits ? describe_fits(*fits) : "") +
              table_from_checks(checks),
          line_of_bake(options.map, result, options.folder), fits && all_passed(checks) ? 0 : 1};
}

int run_many(const RunOptions& options, const Invocation& invocation) {
  refuse_settings_of_one_map(invocation, {"normals", "links"});
  const std::vector<fs::path> maps = find_maps(options.maps);
  const ResultFolder folder(options.folder);
  return run_over_maps(maps, invocation, [&](const fs::path& map) -> MapOutcome {
    RunOptions of_map = options;
    of_map.map.map = map;
    of_map.folder = options.folder / map.stem();
    resolve(of_map, invocation);
    return run_one(of_map, Again::kSkip, invocation);
  });
}

int run_all(RunOptions& options, const Invocation& invocation) {
  if (names_many(options.maps)) return run_many(options, invocation);
  options.map.map = options.maps[0];
  resolve(options, invocation);
  const MapOutcome outcome = run_one(options, Again::kMake, invocation);
  invocation.print(outcome.json, outcome.text);
  return outcome.exit_code;
}

}  // namespace

CommandSetup setup_run() {
  auto options = std::make_shared<RunOptions>();
  CommandSetup setup;
  setup.fields = bake_options(*options);
  take_several_maps(setup.fields, options->maps);
  append(setup.fields, {in_group(shown_as(required(output_option(options->folder,
                                                                 "folder for bake.exr, curves.csv, fit.json "
                                                                 "and check.json; made if new")),
                                          "DIR"),
                                 "Output"),
                        in_group(bins_option(options->bins), "Output")});
  setup.run = [options](const Invocation& invocation) { return run_all(*options, invocation); };
  return setup;
}

}  // namespace hemibake
