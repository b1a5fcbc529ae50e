#include "cli/print/compare.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/common_options.h"
#include "fitting/candidates.h"
#include "io/curves_file.h"

namespace hemibake {
namespace {

struct CompareOptions {
  CommonOptions common;
  std::vector<std::string> curves;
};

int run_compare(const CompareOptions& options) {
  apply_common_options(options.common);
  std::vector<Curves> sets;
  for (const std::string& path : options.curves) sets.push_back(read_curves(path));
  std::vector<ComparedCandidate> compared;
  for (const Candidate& candidate : candidates())
    compared.push_back({&candidate, compare_candidate(candidate, sets)});
  print_result(options.common, json_from_comparisons(compared, options.curves),
               text_from_comparisons(compared, options.curves));
  return 0;
}

}  // namespace

CommandBody setup_compare(CLI::App& app) {
  auto options = std::make_shared<CompareOptions>();
  app.add_option("CURVES", options->curves,
                 "curves, CSV: each model is fitted to each of them, and to all the others together")
      ->required();
  add_common_options(app, options->common);
  return [options] { return run_compare(*options); };
}

}  // namespace hemibake
