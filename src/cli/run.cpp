#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/bake_job.h"
#include "cli/check_report.h"
#include "cli/commands.h"
#include "cli/common_options.h"
#include "cli/file_checks.h"
#include "cli/result_folder.h"
#include "core/error.h"
#include "core/interrupt.h"
#include "curves/curves.h"
#include "fitting/models.h"
#include "io/bake_file.h"
#include "io/curves_file.h"
#include "io/fit_file.h"
#include "io/output_file.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

struct RunOptions {
  CommonOptions common;
  BakeOptions bake;
  fs::path folder;
  int bins = 100;
};

FitFile fit_all(const Curves& curves, const Provenance& provenance) {
  FitFile file;
  file.provenance = provenance;
  for (const char* model : {"published", "bounded"})
    for (NamedFit& named : fit_model(model, curves, Abscissa::kCenter, Weights::kNone))
      file.fits.push_back(std::move(named));
  return file;
}

std::string describe_fits(const FitFile& file) {
  std::string text;
  for (const NamedFit& named : file.fits) {
    text += fmt::format("{:9}", named.name);
    for (const FitParameter& parameter : named.fit.parameters) {
      text += fmt::format(" {} = {:.5g}", parameter.name, parameter.value);
      if (parameter.standard_error) text += fmt::format(" ± {:.2g}", *parameter.standard_error);
      text += ',';
    }
    text += fmt::format(" rms {:.5f}\n", named.fit.rms);
  }
  return text;
}

// A map may have too few AO values for a fit (flat ground has one): that is said, and leaves the rest whole.
// The fit.json of an earlier run would then pass for this one's.
std::optional<FitFile> write_fits_of(const Curves& curves, const RunOptions& options,
                                     const Provenance& provenance) {
  const fs::path path = options.folder / "fit.json";
  FitFile fits;
  try {
    fits = fit_all(curves, provenance);
  } catch (const std::runtime_error& error) {
    throw_if_interrupted();
    fmt::print(stderr, "hemibake: {}: no fit: {}\n", options.bake.map.string(), error.what());
    fs::remove(path);
    return std::nullopt;
  }
  write_fits(path, fits);
  for (const std::string& warning : fit_warnings(fits.fits))
    fmt::print(stderr, "hemibake: {}: warning: {}\n", options.bake.map.string(), warning);
  return fits;
}

int run_all(const CLI::App& app, RunOptions& options) {
  apply_common_options(options.common);
  settle_bake_options(app, options.bake);
  if (!options.bake.wants("ao") || !options.bake.wants("irradiance"))
    throw InputError("--outputs: curves need ao and irradiance, expected both among them");
  const ResultFolder folder(options.folder);
  for (const char* name : {"bake.exr", "curves.csv", "fit.json", "check.json"})
    check_bake_output(options.bake, options.folder / name);
  if (!options.bake.links.empty()) check_bake_output(options.bake, options.bake.links, {".h5", ".hdf5"});

  BakeJob job;
  job.spill_folder = options.folder;
  prepare_bake(options.bake, false, job);
  const BakeResult result = perform_bake(job);
  const BakeFile bake{result.bake, result.provenance};
  write_bake(options.folder / "bake.exr", bake.bake, bake.provenance);

  const Curves curves = make_curves(bake.bake, options.bins);
  write_curves(options.folder / "curves.csv", curves);

  Checks checks = checks_of_bake(bake, std::nullopt);
  write_json(options.folder / "check.json", json_from_checks(checks));
  for (const std::string& warning : result.warnings)
    fmt::print(stderr, "hemibake: {}: warning: {}\n", options.bake.map.string(), warning);

  const std::optional<FitFile> fits = write_fits_of(curves, options, bake.provenance);
  nlohmann::ordered_json json = json_from_bake(job, result);
  json["fits"] = nullptr;
  if (fits) {
    json["fits"] = json_from_fits(*fits);
    json["fits"].erase("provenance");
  }
  json["check"] = json_from_checks(checks);
  print_result(options.common, json,
               describe_bake(job, result) + (fits ? describe_fits(*fits) : "") + table_from_checks(checks));
  return fits && all_passed(checks) ? 0 : 1;
}

}  // namespace

CommandBody setup_run(CLI::App& app) {
  auto options = std::make_shared<RunOptions>();
  add_bake_options(app, options->bake);
  app.add_option("-o,--output", options->folder,
                 "folder for bake.exr, curves.csv, fit.json and check.json; made if new")
      ->required()
      ->option_text("DIR")
      ->group("Output");
  add_bins_option(app, options->bins)->group("Output");
  add_common_options(app, options->common);
  return [&app, options] { return run_all(app, *options); };
}

}  // namespace hemibake
