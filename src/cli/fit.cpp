#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/common_options.h"
#include "cli/name_file.h"
#include "cli/print/fits.h"
#include "fitting/models.h"
#include "io/curves_file.h"
#include "io/fit_file.h"
#include "io/output_file.h"
#include "io/provenance.h"

namespace hemibake {
namespace {

struct FitOptions {
  CommonOptions common;
  std::vector<std::string> curves;
  std::string output;
  std::vector<std::string> models = {"published", "bounded"};
  std::string abscissa = to_string(Abscissa::kCenter);
  std::string weights = to_string(Weights::kNone);
};

// Names every input, in order, in `input` and `input_sha256`.
Provenance provenance_of(const std::vector<std::string>& paths) {
  Provenance provenance = make_provenance(command_line(process_arguments()), paths[0]);
  for (size_t i = 1; i < paths.size(); ++i) {
    const Provenance next = make_provenance("", paths[i]);
    for (const char* name : {"input", "input_sha256"}) {
      provenance[name] = provenance[name].get<std::string>() + ", " + next[name].get<std::string>();
    }
  }
  return provenance;
}

int run_fit(const FitOptions& options) {
  apply_common_options(options.common);
  check_output_path(options.output, {".json"});
  const Abscissa abscissa = abscissa_from_string(options.abscissa);
  const Weights weights = weights_from_string(options.weights);
  if (abscissa == Abscissa::kMayaux2018 && options.curves.size() > 1) {
    throw InputError("--abscissa published: several sets of curves, expected one");
  }
  std::vector<Curves> sets;
  for (const std::string& path : options.curves) sets.push_back(read_curves(path));
  const Curves curves = pool_curves(sets);
  const std::string names = fmt::format("{}", fmt::join(options.curves, ", "));
  FitFile file;
  with_file_context(names, [&] {
    for (const std::string& model : options.models) {
      for (NamedFit& named : fit_model(model, curves, abscissa, weights))
        file.fits.push_back(std::move(named));
    }
  });
  file.provenance = provenance_of(options.curves);
  write_fits(options.output, file);

  for (const std::string& warning : fit_warnings(file.fits)) {
    fmt::print(stderr, "hemibake: {}: warning: {}\n", names, warning);
  }
  print_result(options.common, json_from_fits(file), text_from_fits(file.fits));
  return 0;
}

}  // namespace

CommandBody setup_fit(CLI::App& app) {
  auto options = std::make_shared<FitOptions>();
  std::vector<std::string> names;
  std::string summaries;
  for (const FitModel& model : fit_models()) {
    names.emplace_back(model.name);
    summaries += fmt::format("; {}: {}", model.name, model.summary);
  }
  app.add_option("CURVES", options->curves,
                 "the curves, CSV as 'hemibake curves' writes it, or bin,E0,E1,… of 2018; several: one fit "
                 "to the bins of all")
      ->required();
  app.add_option("-o,--output", options->output, "the fits to write, JSON")->required();
  app.add_option("--model", options->models, "models to fit, separated by commas" + summaries)
      ->delimiter(',')
      ->check(CLI::IsMember(names))
      ->capture_default_str();
  app.add_option("--abscissa", options->abscissa,
                 "where a bin stands on the AO axis; published: (j+1)/(bins-1) for bin j, as in 2018")
      ->check(CLI::IsMember({"center", "published"}))
      ->capture_default_str();
  app.add_option("--weights", options->weights,
                 "weight of a bin: none (all the same), its texel count, or 1/stderr² of its mean")
      ->check(CLI::IsMember({"none", "count", "stderr"}))
      ->capture_default_str();
  add_common_options(app, options->common);
  return [options] { return run_fit(*options); };
}

}  // namespace hemibake
