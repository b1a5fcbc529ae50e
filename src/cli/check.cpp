#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "cli/check_report.h"
#include "cli/commands.h"
#include "cli/common_options.h"
#include "cli/file_checks.h"
#include "cli/validators.h"

namespace hemibake {
namespace {

struct CheckOptions {
  CommonOptions common;
  std::filesystem::path file;
  std::optional<double> tolerance;
};

int run_check(const CheckOptions& options) {
  apply_common_options(options.common);
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
  add_common_options(app, options->common);
  return [options] { return run_check(*options); };
}

}  // namespace hemibake
