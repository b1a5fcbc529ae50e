#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "cli/curve_inputs.h"
#include "cli/options/command.h"
#include "cli/print/fits.h"
#include "cli/print/streams.h"
#include "cli/print/warnings.h"
#include "fitting/models.h"
#include "io/file_context.h"
#include "io/fit_file.h"
#include "io/output_check.h"
#include "io/output_file.h"
#include "io/provenance.h"

namespace hemibake {
namespace {

struct FitOptions {
  std::vector<std::string> curves;
  std::filesystem::path output;
  std::vector<std::string> models = default_fit_models(CurveIndex::kAo);
  std::string abscissa = to_string(Abscissa::kCenter);
  std::string weights = to_string(Weights::kNone);
};

// Names an input: its file, and the map where the file's name does not.
std::string input_name(const CurveInput& input) {
  const std::filesystem::path path = input.path;
  const std::string file = path.filename().string();
  return path.stem() == input.map.name ? file : input.map.name + "/" + file;
}

// Names every input, in order, in `input` and `input_sha256`.
Provenance provenance_of(const std::vector<CurveInput>& inputs, std::string_view command) {
  Provenance provenance = make_provenance(command, inputs[0].path);
  if (inputs.size() == 1) return provenance;
  std::string names, hashes;
  for (const CurveInput& input : inputs) {
    const Provenance next = make_provenance("", input.path);
    const char* separator = names.empty() ? "" : ", ";
    names += separator + input_name(input);
    hashes += separator + next["input_sha256"].get<std::string>();
  }
  provenance["input"] = names;
  provenance["input_sha256"] = hashes;
  return provenance;
}

int run_fit(const FitOptions& options, const Invocation& invocation) {
  check_output_path(options.output, {".json"});
  const Abscissa abscissa = abscissa_from_string(options.abscissa);
  const Weights weights = weights_from_string(options.weights);
  std::vector<std::string> skipped;
  const std::vector<CurveInput> inputs = read_curve_inputs(options.curves, skipped);
  for (const CurveInput& input : inputs) refuse_overwriting_inputs({options.output}, {input.path});
  if (abscissa == Abscissa::kMayaux2018 && inputs.size() > 1)
    throw InputError("--abscissa published: several sets of curves, expected one");
  const std::vector<MapCurves> maps = maps_of(inputs);
  const std::string names = fmt::format("{}", fmt::join(options.curves, ", "));
  const std::vector<std::string> models =
      invocation.given("model") ? options.models : default_fit_models(maps[0].curves.index);
  MapFits fits = with_file_context(names, [&] { return fit_maps(models, maps, abscissa, weights); });
  const FitFile file{std::move(fits.fits), provenance_of(inputs, invocation.context.command),
                     std::move(fits.comparison)};
  write_fits(options.output, file);

  for (const std::string& line : skipped) print_message(line);
  print_warnings(names, fit_warnings(file.fits));
  invocation.print(json_from_fits(file),
                   text_from_fits(file.fits) + text_from_comparison(file.comparison, file.fits));
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
      required(
          option("CURVES", texts(options->curves),
                 "the curves, CSV as 'hemibake curves' writes it, or bin,E0,E1,… of 2018; a bake; a folder "
                 "of maps' results; several maps: one set of constants for all, their own, and errors on "
                 "maps held out")),
      required(output_option(options->output, "the fits to write, JSON")),
      option(
          "model", choices(options->models, names),
          "models to fit, separated by commas; of curves over visibility only visibility unless asked for" +
              summaries),
      option("abscissa", choice(options->abscissa, {"center", "published"}),
             "where a bin stands on the AO axis; published: (j+1)/(bins-1) for bin j, as in 2018"),
      option("weights", choice(options->weights, {"none", "count", "stderr"}),
             "weight of a bin: none (all the same), its texel count, or 1/stderr² of its mean")};
  setup.run = [options](const Invocation& invocation) { return run_fit(*options, invocation); };
  return setup;
}

}  // namespace hemibake
