#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/common_options.h"
#include "cli/name_file.h"
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

int run_export(const ExportOptions& options) {
  apply_common_options(options.common);
  check_output_path(options.output);
  const FitFile file = read_fits(options.fits);
  const ModelKind kind = model_kind_from_string(options.model);
  const ShaderModel model = with_file_context(options.fits, [&] { return fitted_model(file.fits, kind); });
  if (options.target == kTableTarget) {
    write_csv(options.output, table_from_model(model));
  } else {
    OutputFile output(options.output);
    output.write(shader_text(model, kLanguages.at(options.target), model_origin(file, kind)));
    output.commit();
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
