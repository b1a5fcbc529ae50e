#include <fmt/format.h>

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/options/command.h"
#include "fitting/fitted_model.h"
#include "io/file_context.h"
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
  std::string fits;
  std::filesystem::path output;
  std::string target;
  std::string model = "bounded";
};

int run_export(const ExportOptions& options, const Invocation& invocation) {
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
  invocation.print(
      {{"output", options.output.string()}, {"model", options.model}, {"to", options.target}},
      fmt::format("{}: the {} model as {}\n", options.output.string(), options.model, options.target));
  return 0;
}

}  // namespace

CommandSetup setup_export() {
  auto options = std::make_shared<ExportOptions>();
  CommandSetup setup;
  setup.fields = {required(option("FIT", text(options->fits), "the fits, JSON as 'hemibake fit' writes it")),
                  required(option("to", choice(options->target, {"glsl", "hlsl", "cpp", "csv"}),
                                  "glsl, hlsl, cpp: source text; csv: a table over ao and albedo")),
                  required(output_option(options->output, "the file to write")),
                  option("model", choice(options->model, {"bounded", "published"}),
                         "bounded, or published (with its F0 and tau cut to 0..1)")};
  setup.run = [options](const Invocation& invocation) { return run_export(*options, invocation); };
  return setup;
}

}  // namespace hemibake
