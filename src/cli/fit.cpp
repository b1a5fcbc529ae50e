#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "cli/options/command.h"
#include "cli/print/fits.h"
#include "cli/print/warnings.h"
#include "fitting/models.h"
#include "io/curves_file.h"
#include "io/file_context.h"
#include "io/fit_file.h"
#include "io/output_file.h"
#include "io/provenance.h"

namespace hemibake {
namespace {

struct FitOptions {
  std::vector<std::string> curves;
  std::filesystem::path output;
  std::vector<std::string> models = {"published", "bounded"};
  std::string abscissa = to_string(Abscissa::kCenter);
  std::string weights = to_string(Weights::kNone);
};

// Names every input, in order, in `input` and `input_sha256`.
Provenance provenance_of(const std::vector<std::string>& paths, std::string_view command) {
  Provenance provenance = make_provenance(command, paths[0]);
  for (size_t i = 1; i < paths.size(); ++i) {
    const Provenance next = make_provenance("", paths[i]);
    for (const char* name : {"input", "input_sha256"}) {
      provenance[name] = provenance[name].get<std::string>() + ", " + next[name].get<std::string>();
    }
  }
  return provenance;
}

int run_fit(const FitOptions& options, const Invocation& invocation) {
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
  file.provenance = provenance_of(options.curves, invocation.context.command);
  write_fits(options.output, file);

  print_warnings(names, fit_warnings(file.fits));
  invocation.print(json_from_fits(file), text_from_fits(file.fits));
  return 0;
}

}  // namespace

CommandSetup setup_fit() {
  auto options = std::make_shared<FitOptions>();
  std::vector<std::string> names;
  std::string summaries;
  for (const FitModel& model : fit_models()) {
    names.emplace_back(model.name);
    summaries += fmt::format("; {}: {}", model.name, model.summary);
  }
  CommandSetup setup;
  setup.fields = {
      required(option("CURVES", texts(options->curves),
                      "the curves, CSV as 'hemibake curves' writes it, or bin,E0,E1,… of 2018; several: one "
                      "fit to the bins of all")),
      required(output_option(options->output, "the fits to write, JSON")),
      option("model", choices(options->models, names), "models to fit, separated by commas" + summaries),
      option("abscissa", choice(options->abscissa, {"center", "published"}),
             "where a bin stands on the AO axis; published: (j+1)/(bins-1) for bin j, as in 2018"),
      option("weights", choice(options->weights, {"none", "count", "stderr"}),
             "weight of a bin: none (all the same), its texel count, or 1/stderr² of its mean")};
  setup.run = [options](const Invocation& invocation) { return run_fit(*options, invocation); };
  return setup;
}

}  // namespace hemibake
