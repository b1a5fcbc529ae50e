#include <algorithm>
#include <memory>

#include "bake/record.h"
#include "cli/file_checks.h"
#include "cli/options/command.h"
#include "cli/print/checks.h"
#include "cli/print/referee.h"
#include "cli/print/warnings.h"
#include "core/error.h"
#include "io/file_context.h"
#include "io/file_set.h"
#include "io/output_file.h"

namespace hemibake {
namespace {

struct CheckOptions {
  std::filesystem::path file;
  std::optional<double> tolerance;
  bool referee = false;
  RefereeCheckOptions judge;
};

// Reads the bake's map again and measures the bake against it.
RefereeCheck ask_referee(const BakeFile& file, const CheckOptions& options) {
  if (recorded_bake_settings(file.provenance, options.file).margin > 0)
    throw InputError(
        options.file.string() +
        ": is cropped by a margin, which the referee does not know, expected a bake without --margin");
  const LoadedMap map = load_map(recorded_map_settings(file.provenance, options.file));
  return with_file_context(options.file, [&] {
    return check_against_referee(map.surface, {file.bake.visible_fraction, file.bake.irradiance},
                                 options.judge);
  });
}

int run_with_referee(const CheckOptions& options, const Invocation& invocation) {
  if (lower_case_extension(options.file) != ".exr")
    throw InputError(options.file.string() + ": the referee judges bakes, expected a .exr file");
  const BakeFile file = read_bake(options.file);
  const Checks checks = checks_of_bake(file, options.tolerance);
  const RefereeCheck referee = ask_referee(file, options);
  const bool passed = all_passed(checks) && has_passed(referee);
  nlohmann::ordered_json json = json_from_checks(checks);
  json["referee"] = json_from_referee(referee);
  json["passed"] = passed;
  invocation.print(json, table_from_checks(checks) + table_from_referee(referee));
  return passed ? 0 : 1;
}

// Says where a file is not of the run that wrote the record beside it.
void name_mixed_set(const std::filesystem::path& file) {
  const std::vector<std::string> changed = file_set_state(file.parent_path() / "check.json").changed;
  if (std::ranges::find(changed, file.filename().string()) != changed.end())
    print_warnings(file.string(), {"is not of the run that wrote check.json beside it"});
}

int run_check(const CheckOptions& options, const Invocation& invocation) {
  name_mixed_set(options.file);
  if (options.referee) return run_with_referee(options, invocation);
  const Checks checks = checks_of_file(options.file, options.tolerance);
  invocation.print(json_from_checks(checks), table_from_checks(checks));
  return all_passed(checks) ? 0 : 1;
}

}  // namespace

CommandSetup setup_check() {
  auto options = std::make_shared<CheckOptions>();
  RefereeCheckOptions& judge = options->judge;
  CommandSetup setup;
  setup.fields = {
      required(option("FILE", file(options->file), "a bake (.exr), curves (.csv) or fits (.json)")),
      option(
          "tolerance", number(options->tolerance, 1e-12, 1),
          "largest |energy sum / pi - 1| that passes; default: 2e-5, and what the bake says is still under "
          "way may be missing")};
  for (Field field : std::vector<Field>{
           option("referee", flag(options->referee),
                  "measure a sample of the bake's texels again with an unbiased path tracer; needs the map "
                  "where it was, or beside the bake"),
           option("texels", whole(judge.texels, 2, 1 << 28), "texels measured again"),
           option("paths", whole(judge.paths, 1, 1 << 24), "paths per texel"),
           option("confidence", number(judge.confidence, 0.5, 0.999999), "of every interval"),
           option("mean-tolerance", number(judge.mean_tolerance, 1e-6, 1), "of the means, relative"),
           option("bin-tolerance", number(judge.bin_tolerance, 1e-6, 1),
                  "of the means in an AO bin, relative")})
    setup.fields.push_back(in_group(std::move(field), "Referee"));
  setup.run = [options](const Invocation& invocation) { return run_check(*options, invocation); };
  return setup;
}

}  // namespace hemibake
