#include <fmt/format.h>

#include <filesystem>
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

nlohmann::json json_of(const Score& score) { return {{"rms", score.rms}, {"max_error", score.max_error}}; }

int run_compare(const CompareOptions& options, const Invocation& invocation) {
  std::vector<Curves> sets;
  for (const std::string& path : options.curves) sets.push_back(read_curves(path));

  nlohmann::json results = nlohmann::json::array();
  std::string text =
      "rms (largest) error of E/pi over the bins x albedo 0..1, fitted to the curves: themselves | the "
      "others\n";
  text += fmt::format("{:18} {:>10} {:>8}", "model", "parameters", "AICc");
  for (const std::string& path : options.curves) {
    text += fmt::format("  {:^31}", std::filesystem::path(path).stem().string());
  }
  for (const Candidate& candidate : candidates()) {
    const Comparison comparison = compare_candidate(candidate, sets);
    nlohmann::json errors = nlohmann::json::array();
    text += fmt::format("\n{:18} {:10} {:>8}", candidate.name, candidate.parameters,
                        comparison.aicc ? fmt::format("{:.1f}", *comparison.aicc) : "");
    for (size_t i = 0; i < sets.size(); ++i) {
      const Score& own = comparison.own[i];
      nlohmann::json error = {{"curves", options.curves[i]}, {"own", json_of(own)}};
      text += fmt::format("  {:.4f} ({:5.3f})", own.rms, own.max_error);
      if (sets.size() > 1) {
        const Score& others = comparison.others[i];
        error["others"] = json_of(others);
        text += fmt::format(" | {:.4f} ({:5.3f})", others.rms, others.max_error);
      }
      errors.push_back(error);
    }
    results.push_back({{"model", candidate.name},
                       {"formula", candidate.formula},
                       {"parameters", candidate.parameters},
                       {"aicc", comparison.aicc ? nlohmann::json(*comparison.aicc) : nlohmann::json(nullptr)},
                       {"errors", errors}});
  }
  invocation.print({{"models", results}}, text + "\n");
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
