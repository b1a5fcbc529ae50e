#include "curves/curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/options/command.h"
#include "io/bake_file.h"
#include "io/curves_file.h"
#include "io/file_context.h"
#include "io/output_check.h"
#include "io/output_file.h"

namespace hemibake {
namespace {

struct CurvesOptions {
  std::string bake;
  std::filesystem::path output;
  int bins = 100;
  CurveIndex index = CurveIndex::kAo;
};

int run_curves(const CurvesOptions& options, const Invocation& invocation) {
  check_output_path(options.output, {".csv"});
  refuse_overwriting_inputs({options.output}, {options.bake});
  const Bake bake = read_bake(options.bake).bake;
  const Curves curves =
      with_file_context(options.bake, [&] { return make_curves(bake, options.bins, options.index); });
  write_curves(options.output, curves);

  const auto populated = std::count_if(curves.bins.begin(), curves.bins.end(),
                                       [](const CurveBin& bin) { return bin.count > 0; });
  const size_t texels = bake.irradiance.front().size();
  invocation.print({{"output", options.output.string()},
                    {"index", to_string(options.index)},
                    {"bins", options.bins},
                    {"populated", populated},
                    {"curves", curves.bounce_count},
                    {"texels", texels}},
                   fmt::format("{}: {} curves over {} of {} bins, {} of them populated, {} texels\n",
                               options.output.string(), curves.bounce_count, to_string(options.index),
                               options.bins, populated, texels));
  return 0;
}

}  // namespace

CommandSetup setup_curves() {
  auto options = std::make_shared<CurvesOptions>();
  CommandSetup setup;
  setup.fields = {
      required(option("BAKE", text(options->bake),
                      "the bake, EXR with channels ao (not for --index visibility) and irradiance.00…")),
      required(output_option(options->output, "the curves to write, CSV")), bins_option(options->bins),
      option("index", choice(options->index, {"ao", "visibility"}),
             "the AO that sorts the texels; ao: uniform visible fraction, as in 2018; visibility: the "
             "cosine-weighted one, E0/pi")};
  setup.run = [options](const Invocation& invocation) { return run_curves(*options, invocation); };
  return setup;
}

}  // namespace hemibake
