#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "cli/bake_surface.h"
#include "cli/check_report.h"
#include "cli/commands.h"
#include "cli/common_options.h"
#include "cli/file_checks.h"
#include "cli/name_file.h"
#include "cli/referee_report.h"
#include "cli/validators.h"
#include "core/error.h"
#include "io/output_file.h"

namespace hemibake {
namespace {

struct CheckOptions {
  CommonOptions common;
  std::filesystem::path file;
  std::optional<double> tolerance;
  bool referee = false;
  RefereeCheckOptions judge;
};

// The bake's map, read again, and the bake measured against it.
RefereeCheck ask_referee(const BakeFile& file, const CheckOptions& options) {
  const BakeMap map = load_bake_map(map_options_from(file.provenance, options.file));
  return with_file_context(options.file, [&] {
    return check_against_referee(map.surface, {file.bake.visible_fraction, file.bake.irradiance},
                                 options.judge);
  });
}

int run_with_referee(const CheckOptions& options) {
  if (lower_case_extension(options.file) != ".exr")
    throw InputError(options.file.string() + ": the referee judges bakes, expected a .exr file");
  const BakeFile file = read_bake(options.file);
  const Checks checks = checks_of_bake(file, options.tolerance);
  const RefereeCheck referee = ask_referee(file, options);
  nlohmann::ordered_json json = json_from_checks(checks);
  json["referee"] = json_from_referee(referee);
  const bool passed = all_passed(checks) && json["referee"]["passed"].get<bool>();
  json["passed"] = passed;
  print_result(options.common, json, table_from_checks(checks) + table_from_referee(referee));
  return passed ? 0 : 1;
}

int run_check(const CheckOptions& options) {
  apply_common_options(options.common);
  if (options.referee) return run_with_referee(options);
  const Checks checks = checks_of_file(options.file, options.tolerance);
  print_result(options.common, json_from_checks(checks), table_from_checks(checks));
  return all_passed(checks) ? 0 : 1;
}

}  // namespace

CommandBody setup_check(CLI::App& app) {
  auto options = std::make_shared<CheckOptions>();
  app.add_option("FILE", options->file, "a bake (.exr), curves (.csv) or fits (.json)")->required();
  app.add_option("--tolerance", options->tolerance,
                 "largest |energy sum / pi - 1| that passes; default: 2e-5, and what the bake says is still "
                 "under way may be missing")
      ->check(number_in(1e-12, 1));
  constexpr const char* kReferee = "Referee";
  RefereeCheckOptions& judge = options->judge;
  app.add_flag("--referee", options->referee,
               "measure a sample of the bake's texels again with an unbiased path tracer; needs the map "
               "where it was, or beside the bake")
      ->group(kReferee);
  app.add_option("--texels", judge.texels, "texels measured again")
      ->check(whole_number_in(2, 1 << 28))
      ->capture_default_str()
      ->group(kReferee);
  app.add_option("--paths", judge.paths, "paths per texel")
      ->check(whole_number_in(1, 1 << 24))
      ->capture_default_str()
      ->group(kReferee);
  app.add_option("--confidence", judge.confidence, "of every interval")
      ->check(number_in(0.5, 0.999999))
      ->capture_default_str()
      ->group(kReferee);
  app.add_option("--mean-tolerance", judge.mean_tolerance, "of the means, relative")
      ->check(number_in(1e-6, 1))
      ->capture_default_str()
      ->group(kReferee);
  app.add_option("--bin-tolerance", judge.bin_tolerance, "of the means in an AO bin, relative")
      ->check(number_in(1e-6, 1))
      ->capture_default_str()
      ->group(kReferee);
  add_common_options(app, options->common);
  return [options] { return run_check(*options); };
}

}  // namespace hemibake
