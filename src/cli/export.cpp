#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/common_options.h"
#include "fitting/fitted_model.h"
#include "io/fit_file.h"
#include "io/model_table.h"
#include "io/output_file.h"
#include "model/shader_text.h"

namespace hemibake {
namespace {

const std::map<std::string, Language> kLanguages = {
    {"glsl", Language::kGlsl}, {"hlsl", Language::kHlsl}, {"cpp", Language::kCpp}};
constexpr const char* kTableTarget = "csv";

struct ExportOptions {
  CommonOptions common;
  std::string fits;
  std::string output;
  std::string target;
  std::string model = "bounded";
};

// The model in the form asked for.
template <class Model>
void write_model(const Model& model, const ExportOptions& options, const std::vector<std::string>& origin) {
  if (options.target == kTableTarget) return write_csv(options.output, table_from_model(model));
  OutputFile file(options.output);
  file.write(shader_text(model, kLanguages.at(options.target), origin));
  file.commit();
}

int run_export(const ExportOptions& options) {
  apply_common_options(options.common);
  check_output_path(options.output);
  const FitFile file = read_fits(options.fits);
  if (options.model == "bounded") {
    write_model(bounded_model(file, options.fits), options, bounded_model_origin(file, options.fits));
  } else {
    write_model(guarded_model(file, options.fits), options, guarded_model_origin(file, options.fits));
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
