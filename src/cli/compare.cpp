#include "cli/print/compare.h"

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/options/command.h"
#include "fitting/candidates.h"
#include "io/curves_file.h"

namespace hemibake {
namespace {

struct CompareOptions {
  std::vector<std::string> curves;
};

int run_compare(const CompareOptions& options, const Invocation& invocation) {
  std::vector<Curves> sets;
  for (const std::string& path : options.curves) sets.push_back(read_curves(path));
  std::vector<ComparedCandidate> compared;
  for (const Candidate& candidate : candidates())
    compared.push_back({&candidate, compare_candidate(candidate, sets)});
  invocation.print(json_from_comparisons(compared, options.curves),
                   text_from_comparisons(compared, options.curves));
  return 0;
}

}  // namespace

CommandSetup setup_compare() {
  auto options = std::make_shared<CompareOptions>();
  CommandSetup setup;
  setup.fields = {
      required(option("CURVES", texts(options->curves),
                      "curves, CSV: each model is fitted to each of them, and to all the others together"))};
  setup.run = [options](const Invocation& invocation) { return run_compare(*options, invocation); };
  return setup;
}

}  // namespace hemibake
