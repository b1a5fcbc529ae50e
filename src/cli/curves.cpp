#include "curves/curves.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/common_options.h"
#include "cli/name_file.h"
#include "io/bake_file.h"
#include "io/curves_file.h"
#include "io/output_file.h"

namespace hemibake {
namespace {

struct CurvesOptions {
  CommonOptions common;
  std::string bake;
  std::string output;
  int bins = 100;
};

int run_curves(const CurvesOptions& options) {
  apply_common_options(options.common);
  check_output_path(options.output, {".csv"});
  const Bake bake = read_bake(options.bake).bake;
  const Curves curves = with_file_context(options.bake, [&] { return make_curves(bake, options.bins); });
  write_curves(options.output, curves);

  const auto populated = std::count_if(curves.bins.begin(), curves.bins.end(),
                                       [](const CurveBin& bin) { return bin.count > 0; });
  const size_t texels = bake.visible_fraction.size();
  print_result(options.common,
               {{"output", options.output},
                {"bins", options.bins},
                {"populated", populated},
                {"curves", curves.bounce_count},
                {"texels", texels}},
               fmt::format("{}: {} curves of {} bins, {} of them populated, {} texels\n", options.output,
                           curves.bounce_count, options.bins, populated, texels));
  return 0;
}

}  // namespace

CommandBody setup_curves(CLI::App& app) {
  auto options = std::make_shared<CurvesOptions>();
  app.add_option("BAKE", options->bake, "the bake, EXR with channels ao and irradiance.00…")->required();
  app.add_option("-o,--output", options->output, "the curves to write, CSV")->required();
  add_bins_option(app, options->bins);
  add_common_options(app, options->common);
  return [options] { return run_curves(*options); };
}

}  // namespace hemibake
