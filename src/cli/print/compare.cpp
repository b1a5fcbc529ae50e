#include "cli/print/compare.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

namespace hemibake {
namespace {

nlohmann::json json_from_score(const Score& score) {
  return {{"rms", score.rms}, {"max_error", score.max_error}};
}

}  // namespace

nlohmann::json json_from_comparisons(std::span<const ComparedCandidate> candidates,
                                     std::span<const std::string> paths) {
  nlohmann::json models = nlohmann::json::array();
  for (const auto& [candidate, comparison] : candidates) {
    nlohmann::json errors = nlohmann::json::array();
    for (size_t i = 0; i < paths.size(); ++i) {
      errors.push_back({{"curves", paths[i]}, {"own", json_from_score(comparison.own[i])}});
      if (!comparison.others.empty()) errors.back()["others"] = json_from_score(comparison.others[i]);
    }
    models.push_back({{"model", candidate->name},
                      {"formula", candidate->formula},
                      {"parameters", candidate->parameters},
                      {"aicc", comparison.aicc ? nlohmann::json(*comparison.aicc) : nlohmann::json()},
                      {"errors", errors}});
  }
  return {{"models", models}};
}

std::string text_from_comparisons(std::span<const ComparedCandidate> candidates,
                                  std::span<const std::string> paths) {
  std::string text =
      "rms (largest) error of E/pi over the bins x albedo 0..1, fitted to the curves: themselves | the "
      "others\n";
  text += fmt::format("{:18} {:>10} {:>8}", "model", "parameters", "AICc");
  for (const std::string& path : paths)
    text += fmt::format("  {:^31}", std::filesystem::path(path).stem().string());
  for (const auto& [candidate, comparison] : candidates) {
    text += fmt::format("\n{:18} {:10} {:>8}", candidate->name, candidate->parameters,
                        comparison.aicc ? fmt::format("{:.1f}", *comparison.aicc) : "");
    for (size_t i = 0; i < paths.size(); ++i) {
      text += fmt::format("  {:.4f} ({:5.3f})", comparison.own[i].rms, comparison.own[i].max_error);
      if (!comparison.others.empty())
        text += fmt::format(" | {:.4f} ({:5.3f})", comparison.others[i].rms, comparison.others[i].max_error);
    }
  }
  return text + "\n";
}

}  // namespace hemibake
