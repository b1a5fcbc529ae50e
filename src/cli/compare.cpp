#include "cli/print/compare.h"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/curve_inputs.h"
#include "cli/options/command.h"
#include "cli/print/streams.h"
#include "fitting/candidates.h"

namespace hemibake {
namespace {

struct CompareOptions {
  std::vector<std::string> curves;
};

int run_compare(const CompareOptions& options, const Invocation& invocation) {
  std::vector<std::string> skipped;
  std::vector<ComparedMap> maps;
  std::vector<Curves> sets;
  for (CurveInput& input : read_curve_inputs(options.curves, skipped)) {
    maps.push_back({input.map.name, input.path});
    sets.push_back(std::move(input.map.curves));
  }
  std::vector<ComparedCandidate> compared;
  for (const Candidate& candidate : candidates())
    if (!candidate.needs_ao || sets[0].index == CurveIndex::kAo)
      compared.push_back({&candidate, compare_candidate(candidate, sets)});
  for (const std::string& line : skipped) print_message(line);
  invocation.print(json_from_comparisons(compared, maps), text_from_comparisons(compared, maps));
  return 0;
}

}  // namespace

CommandSetup setup_compare() {
  auto options = std::make_shared<CompareOptions>();
  CommandSetup setup;
  setup.fields = {
      required(option("CURVES", texts(options->curves),
                      "curves as CSV, bakes, or folders of maps' results: each model is fitted to each of "
                      "them, and to all the others together"))};
  setup.run = [options](const Invocation& invocation) { return run_compare(*options, invocation); };
  return setup;
}

}  // namespace hemibake
