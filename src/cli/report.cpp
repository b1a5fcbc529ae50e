#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/options/command.h"
#include "cli/print/streams.h"
#include "core/error.h"
#include "io/file_context.h"
#include "io/file_set.h"
#include "io/output_check.h"
#include "io/output_file.h"
#include "report/html_data.h"
#include "report/html_folder.h"
#include "report/html_json.h"
#include "report/html_page.h"
#include "report/html_planes.h"

namespace hemibake {
namespace {

constexpr int kLargestSide = 16384;

struct ReportOptions {
  std::filesystem::path folder;
  std::filesystem::path output;
  std::vector<double> albedo = {0.9, 0.6, 0.2};
  int image_size = 512;
};

// Files of a folder that name others.
constexpr const char* kRecords[] = {"check.json", "trade.json", "render.json", "pictures/render.json"};

// Returns the files that a report may read from a folder by a fixed name.
std::vector<std::filesystem::path> inputs_of(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> inputs;
  for (const char* name : {"bake.exr", "curves.csv", "fit.json", "run.json"}) inputs.push_back(folder / name);
  for (const char* record : kRecords) inputs.push_back(folder / record);
  return inputs;
}

int run_report(ReportOptions options, const Invocation& invocation) {
  if (page_template().empty())
    throw InputError("report: this build has no report, expected one made with Node and npm");
  if (options.output.empty()) options.output = options.folder / "report.html";
  for (const char* record : kRecords) check_file_set(options.folder / record, {"fit.json"});
  const ReportFolder folder = read_report_folder(options.folder);
  check_output_path(options.output, {".html", ".htm"});
  refuse_overwriting_inputs({options.output}, inputs_of(options.folder));
  for (const std::string& warning : folder.warnings) print_message(warning);
  for (const char* record : kRecords)
    for (const std::string& name : file_set_state(options.folder / record).missing)
      print_message(
          fmt::format("{}: warning: names {}, which is not there", (options.folder / record).string(), name));

  Bake bake = folder.bake ? folder.bake->bake : Bake{};
  show_holes_as_open_ground(bake);
  const PackedPlanes planes =
      with_file_context(options.folder / "bake.exr", [&] { return pack_planes(bake, options.image_size); });
  const std::vector<ReportModel> models = with_file_context(
      options.folder / "fit.json", [&] { return report_models(folder.fits, folder.bake ? &bake : nullptr); });
  const Rgb albedo = {options.albedo[0], options.albedo[1], options.albedo[2]};
  const ReportData data = gather_report(folder, models, albedo);
  const std::string page =
      fill_page(page_template(), json_from_report(folder, models, planes, data), planes, folder.pictures);
  OutputFile file(options.output);
  file.write(page);
  file.commit();

  invocation.print({{"output", options.output.string()},
                    {"bytes", page.size()},
                    {"image", {planes.width, planes.height}},
                    {"stride", planes.stride},
                    {"ao_error", planes.ao_error},
                    {"bounce_error", planes.bounce_error},
                    {"irradiance_error_over_pi", planes.irradiance_error_over_pi},
                    {"total_error_over_pi", planes.total_error_over_pi},
                    {"albedo", albedo},
                    {"probes", json_from_probes(report_probes(bake, models, planes.stride, albedo), models)},
                    {"bins", folder.curves ? json_from_totals(*folder.curves, data.totals)
                                           : nlohmann::ordered_json::array()}},
                   fmt::format("{}: {:.1f} MiB\n", options.output.string(),
                               static_cast<double>(page.size()) / (1024.0 * 1024)));
  return 0;
}

}  // namespace

CommandSetup setup_report() {
  auto options = std::make_shared<ReportOptions>();
  CommandSetup setup;
  setup.fields = {
      required(option(
          "DIR", file(options->folder),
          "folder of 'hemibake run': bake.exr, curves.csv, fit.json, check.json, as far as they are there; "
          "also run.json (what 'run --json' printed), trade.json, the curves of scripts/sweep, and the "
          "pictures of 'hemibake render' (render.json there or in DIR/pictures)")),
      output_option(options->output, "the page to write, HTML; default: DIR/report.html"),
      option("albedo", numbers(options->albedo, 3, 0, 1), "the albedo the image opens with: R,G,B, linear"),
      option("image-size", whole(options->image_size, 1, kLargestSide),
             "longer side of the image, texels; of a larger bake every second, third, … texel is taken")};
  setup.run = [options](const Invocation& invocation) { return run_report(*options, invocation); };
  return setup;
}

}  // namespace hemibake
