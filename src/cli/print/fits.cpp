#include "cli/print/fits.h"

#include <fmt/format.h>

#include "cli/print/columns.h"

namespace hemibake {
namespace {

constexpr size_t kWidth = 80;
constexpr size_t kIndent = 14;
constexpr size_t kFitNameWidth = 15;
constexpr size_t kConstantWidth = 9;
constexpr size_t kFitsInRow = 3;

std::string constant(const FitParameter& parameter) {
  std::string text = fmt::format("{} = {:.6g}", parameter.name, parameter.value);
  if (parameter.standard_error) text += fmt::format(" ± {:.2g}", *parameter.standard_error);
  return text + (parameter.on_bound ? " on its bound" : "");
}

// Returns a sentence on errors that hold for parameters on their bounds; empty where none or all are there.
std::string condition_of(const Fit& fit) {
  const auto bound = std::ranges::count_if(fit.parameters, &FitParameter::on_bound);
  if (bound == 0 || bound == std::ssize(fit.parameters)) return "";
  return bound == 1 ? "errors hold with it there" : "errors hold with them there";
}

std::string cell(const FitParameter& parameter) {
  return fmt::format("{:>{}}", fmt::format("{:.4g}{}", parameter.value, parameter.on_bound ? "*" : ""),
                     kConstantWidth);
}

// fits: of one map, in the order of `shared`; a fit that is missing leaves its cells empty.
std::string constants_row(const std::string& name, std::span<const NamedFit> shared,
                          const std::vector<const Fit*>& fits) {
  std::string text = fit_name(name, kFitNameWidth);
  for (size_t i = 0; i < shared.size(); ++i)
    for (size_t p = 0; p < shared[i].fit.parameters.size(); ++p)
      text += fits[i] ? cell(fits[i]->parameters[p]) : fmt::format("{:>{}}", "-", kConstantWidth);
  return text + "\n";
}

// Returns the fit of the map called `name`; null without one.
const Fit* find_fit(const MapErrors& map, const std::string& name) {
  for (const ModelOnMap& model : map.models)
    for (const NamedFit& named : model.fits)
      if (named.name == name) return &named.fit;
  return nullptr;
}

std::string constants_table(const MapComparison& comparison, std::span<const NamedFit> fits) {
  std::string head(kFitNameWidth, ' '), names(kFitNameWidth, ' ');
  for (const auto& [name, fit] : fits) {
    head += fmt::format("{:>{}}", name, kConstantWidth * fit.parameters.size());
    for (const FitParameter& parameter : fit.parameters)
      names += fmt::format("{:>{}}", parameter.name, kConstantWidth);
  }
  std::vector<const Fit*> shared;
  for (const NamedFit& named : fits) shared.push_back(&named.fit);
  std::string text = head + "\n" + names + "\n" + constants_row("all", fits, shared);
  for (const MapErrors& map : comparison.maps) {
    std::vector<const Fit*> own;
    for (const NamedFit& named : fits) own.push_back(find_fit(map, named.name));
    text += constants_row(map.name, fits, own);
  }
  return text;
}

std::string rms(const std::optional<Score>& score) {
  return score ? fmt::format("{:7.4f}", score->rms) : fmt::format("{:>7}", "-");
}

std::string errors_table(const MapComparison& comparison) {
  std::string text = fmt::format("{:{}}{:7}", "", kFitNameWidth, "");
  for (const std::string& model : comparison.models) text += fmt::format(" {:>14}", model);
  text += fmt::format("\n{:{}}{:>7}", "map", kFitNameWidth, "m");
  for (size_t m = 0; m < comparison.models.size(); ++m) text += fmt::format(" {:>7}{:>7}", "own", "held");
  for (const MapErrors& map : comparison.maps) {
    text += "\n" + fit_name(map.name, kFitNameWidth) +
            (map.mean_escape ? fmt::format("{:7.3f}", *map.mean_escape) : fmt::format("{:>7}", "-"));
    for (const ModelOnMap& model : map.models) text += " " + rms(model.own) + rms(model.held_out);
  }
  text += fmt::format("\n{:{}}{:7}", "mean", kFitNameWidth, "");
  for (const std::optional<double>& held_out : comparison.held_out_rms)
    text += fmt::format(" {:7}{}", "", rms(held_out ? std::optional(Score{*held_out, 0}) : std::nullopt));
  return text + "\n";
}

}  // namespace

std::string text_from_fits(std::span<const NamedFit> fits) {
  std::string text;
  for (const auto& [name, fit] : fits) {
    std::vector<std::string> pieces;
    for (const FitParameter& parameter : fit.parameters) pieces.push_back(constant(parameter));
    if (const std::string condition = condition_of(fit); !condition.empty())
      pieces.back() += " (" + condition + ")";
    pieces.push_back(fmt::format("rms {:.5f}", fit.rms));
    pieces.push_back(fmt::format("max {:.5f}", fit.max_error));
    pieces.push_back(fmt::format("{} points", fit.points));
    text += fmt::format("{:{}}{}\n", name + " ", kIndent, fit.formula) + wrap_list(pieces, kIndent, kWidth);
  }
  return text;
}

std::string text_from_comparison(const MapComparison& comparison, std::span<const NamedFit> shared) {
  if (comparison.maps.size() == 1) {
    const std::optional<double> m = comparison.maps[0].mean_escape;
    return m ? fmt::format("{:{}}mean chance of escape, (<V> - <V^2>)/(1 - <V>)\n{:{}}m = {:.4f}\n", "m",
                           kIndent, "", kIndent, *m)
             : "";
  }
  std::string text = "\nConstants of all maps together and of each, * on its bound\n";
  for (size_t i = 0; i < shared.size(); i += kFitsInRow)
    text += constants_table(comparison, shared.subspan(i, std::min(kFitsInRow, shared.size() - i)));
  if (comparison.models.empty()) return text;
  text +=
      "\nrms error of E/pi over the bins x albedo 0..1\nown: fitted to the map; held: to all the others\n" +
      errors_table(comparison);
  if (comparison.winner.empty()) return text;
  return text + fmt::format("carries best from map to map: {}\n", comparison.winner);
}

}  // namespace hemibake
