#include "cli/print/compare.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cli/print/columns.h"

namespace hemibake {
namespace {

nlohmann::json json_from_score(const Score& score) {
  return {{"rms", score.rms}, {"max_error", score.max_error}};
}

constexpr size_t kNameWidth = 18;
constexpr size_t kMapsInRow = 4;

std::string cell(const Score& score) { return fmt::format("{:.4f} ({:.3f})", score.rms, score.max_error); }

// Returns a row of names, and one of errors for each candidate. errors: Comparison::own or ::others.
// begin, end: of the maps in this block.
std::string block(std::span<const ComparedCandidate> candidates, std::span<const ComparedMap> maps,
                  std::vector<Score> Comparison::*errors, size_t begin, size_t end) {
  std::string text(kNameWidth, ' ');
  for (size_t i = begin; i < end; ++i) text += fmt::format(" {:>15}", fit_name(maps[i].name, 15));
  for (const auto& [candidate, comparison] : candidates) {
    text += fmt::format("\n{:{}}", candidate->name, kNameWidth);
    for (size_t i = begin; i < end; ++i) text += fmt::format(" {:>15}", cell((comparison.*errors)[i]));
  }
  return text + "\n";
}

double mean_rms(const std::vector<Score>& scores) {
  double sum = 0;
  for (const Score& score : scores) sum += score.rms;
  return sum / static_cast<double>(scores.size());
}

// Returns a line for each candidate: constants, AICc, mean errors, formula.
std::string overview(std::span<const ComparedCandidate> candidates) {
  std::string text = fmt::format("{:{}} {:>2} {:>9} {:>7} {:>7}  {}", "", kNameWidth, "p", "AICc", "own",
                                 "others", "formula");
  for (const auto& [candidate, comparison] : candidates)
    text += fmt::format(
        "\n{:{}} {:2} {:>9} {:7.4f} {:>7}  {}", candidate->name, kNameWidth, candidate->parameters,
        comparison.aicc ? fmt::format("{:.1f}", *comparison.aicc) : "-", mean_rms(comparison.own),
        comparison.others.empty() ? "-" : fmt::format("{:.4f}", mean_rms(comparison.others)),
        candidate->formula);
  return text + "\n";
}

}  // namespace

nlohmann::json json_from_comparisons(std::span<const ComparedCandidate> candidates,
                                     std::span<const ComparedMap> maps) {
  nlohmann::json models = nlohmann::json::array();
  for (const auto& [candidate, comparison] : candidates) {
    nlohmann::json errors = nlohmann::json::array();
    for (size_t i = 0; i < maps.size(); ++i) {
      errors.push_back(
          {{"map", maps[i].name}, {"curves", maps[i].path}, {"own", json_from_score(comparison.own[i])}});
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
                                  std::span<const ComparedMap> maps) {
  std::string text =
      "rms (largest) error of E/pi over the bins x albedo 0..1, means over the maps; p: fitted constants\n" +
      overview(candidates);
  const bool several = maps.size() > 1;
  for (size_t begin = 0; begin < maps.size(); begin += kMapsInRow) {
    const size_t end = std::min(maps.size(), begin + kMapsInRow);
    text += "\nfitted to the map itself\n" + block(candidates, maps, &Comparison::own, begin, end);
    if (several)
      text += "\nfitted to all the others\n" + block(candidates, maps, &Comparison::others, begin, end);
  }
  return text;
}

}  // namespace hemibake
