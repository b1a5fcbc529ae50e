#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/common_options.h"
#include "core/error.h"
#include "io/fit_file.h"
#include "io/model_table.h"
#include "io/output_file.h"
#include "model/shader_text.h"

namespace hemibake {
namespace {

const std::map<std::string, Language> kLanguages = {
    {"glsl", Language::glsl}, {"hlsl", Language::hlsl}, {"cpp", Language::cpp}};
constexpr const char* kTableTarget = "csv";

struct ExportOptions {
  CommonOptions common;
  std::string fits;
  std::string output;
  std::string target;
  std::string model = "bounded";
};

const Fit& find_fit(const FitFile& file, const std::string& name, const ExportOptions& options) {
  for (const NamedFit& named : file.fits) {
    if (named.name == name) return named.fit;
  }
  throw InputError(fmt::format("{}: no fit {}, expected one from 'hemibake fit --model {}'", options.fits,
                               name, options.model));
}

struct ConstantRange {
  const char* name;
  double lowest, highest;
};

double constant(const Fit& fit, const ConstantRange& range, const ExportOptions& options) {
  for (const FitParameter& parameter : fit.parameters) {
    if (parameter.name != range.name) continue;
    if (parameter.value >= range.lowest && parameter.value <= range.highest) return parameter.value;
    throw InputError(fmt::format("{}: {} of {} is {}, expected {} to {}", options.fits, range.name, fit.model,
                                 parameter.value, range.lowest, range.highest));
  }
  throw InputError(
      fmt::format("{}: {} has no parameter {}, expected one", options.fits, fit.model, range.name));
}

// Where the constants come from, for the head of the text.
std::vector<std::string> origin_lines(const FitFile& file, const std::vector<const Fit*>& fits) {
  std::vector<std::string> lines = {
      "Ambient occlusion with all bounces of light, by hemibake " HEMIBAKE_VERSION "."};
  for (const Fit* fit : fits) {
    std::string line = fmt::format("{} = {} with", fit->model, fit->formula);
    for (const FitParameter& parameter : fit->parameters) {
      line += fmt::format(" {} = {:.6g}", parameter.name, parameter.value);
      if (parameter.standard_error) line += fmt::format(" +- {:.2g}", *parameter.standard_error);
    }
    lines.push_back(line + fmt::format(" (a = ao; rms {:.2g}, max {:.2g})", fit->rms, fit->max_error));
  }
  for (const char* name : {"input", "input_sha256", "command"}) {
    if (file.provenance.contains(name) && file.provenance[name].is_string()) {
      lines.push_back(fmt::format("{}: {}", name, file.provenance[name].get<std::string>()));
    }
  }
  return lines;
}

// The model in the form asked for.
template <class Model>
void write_model(const Model& model, const ExportOptions& options, const std::vector<std::string>& origin) {
  if (options.target == kTableTarget) return write_csv(options.output, table_from_model(model));
  OutputFile file(options.output);
  file.write(shader_text(model, kLanguages.at(options.target), origin));
  file.commit();
}

void write_bounded(const FitFile& file, const ExportOptions& options) {
  const Fit& direct = find_fit(file, "bounded_F0", options);
  const Fit& tau = find_fit(file, "bounded_tau", options);
  const BoundedModel model{constant(direct, {"k0", -1, 1}, options), constant(direct, {"k1", -1, 1}, options),
                           constant(tau, {"q", 1e-6, 1}, options),
                           constant(tau, {"d", 0, 0.999999}, options)};
  write_model(model, options, origin_lines(file, {&direct, &tau}));
}

// The ranges keep every step of the formulas finite in float.
void write_published(const FitFile& file, const ExportOptions& options) {
  const Fit& direct = find_fit(file, "F0", options);
  const Fit& first = find_fit(file, "F1", options);
  const GuardedModel model{{constant(direct, {"k", -100, 100}, options),
                            constant(direct, {"e", 0, 100}, options), constant(first, {"A", 0, 1e9}, options),
                            constant(first, {"B", -60, 60}, options)}};
  write_model(model, options, origin_lines(file, {&direct, &first}));
}

int run_export(const ExportOptions& options) {
  apply_common_options(options.common);
  check_output_path(options.output);
  const FitFile file = read_fits(options.fits);
  if (options.model == "bounded") {
    write_bounded(file, options);
  } else {
    write_published(file, options);
  }
  print_result(options.common, {{"output", options.output}, {"model", options.model}, {"to", options.target}},
               fmt::format("{}: the {} model as {}\n", options.output, options.model, options.target));
  return 0;
}

}  // namespace

CommandBody setup_export(CLI::App& app) {
  auto options = std::make_shared<ExportOptions>();
  app.add_option("FIT", options->fits, "the fits, JSON as 'hemibake fit' writes it")->required();
  app.add_option("--to", options->target, "glsl, hlsl, cpp: source text; csv: a table over ao and albedo")
      ->required()
      ->check(CLI::IsMember({"glsl", "hlsl", "cpp", "csv"}));
  app.add_option("-o,--output", options->output, "the file to write")->required();
  app.add_option("--model", options->model, "bounded, or published (with its F0 and tau cut to 0..1)")
      ->check(CLI::IsMember({"bounded", "published"}))
      ->capture_default_str();
  add_common_options(app, options->common);
  return [options] { return run_export(*options); };
}

}  // namespace hemibake
