// Studies what to put into a shader (fits/README.md, "Tiers"): forms of the escape share g against the truth
// of the light at every texel, two textures, and albedo that varies. Prints Markdown tables.
//
//   hemibake_bench_escape [SIDE [AZIMUTHS [FOLDER]]]     96 texels, 32 azimuths; FOLDER keeps the truth
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <set>

#include "bench/escape_forms.h"
#include "bench/escape_textures.h"
#include "core/parallel.h"

namespace hemibake {
namespace {

constexpr size_t kSplits = 24;

using Maps = std::vector<const MapTruth*>;

// A random half of the kinds to fit, the other half to test.
struct Split {
  Maps fitted, held;
};

std::vector<Split> split_kinds(const std::vector<MapTruth>& maps) {
  std::set<std::string> names;
  for (const MapTruth& map : maps) names.insert(map.kind);
  std::vector<std::string> kinds(names.begin(), names.end());
  std::mt19937 random(7);
  std::vector<Split> splits(kSplits);
  for (Split& split : splits) {
    // Fisher-Yates by hand: std::shuffle differs between libraries.
    for (size_t i = kinds.size() - 1; i > 0; --i) std::swap(kinds[i], kinds[random() % (i + 1)]);
    const std::set<std::string> half(kinds.begin(), kinds.begin() + static_cast<long>(kinds.size() / 2));
    for (const MapTruth& map : maps) (half.contains(map.kind) ? split.fitted : split.held).push_back(&map);
  }
  return splits;
}

// Mean and standard deviation over the splits.
struct Held {
  double mean = 0, spread = 0;
};

Held held_of(const std::vector<double>& errors) {
  Held held;
  for (const double error : errors) held.mean += error / static_cast<double>(errors.size());
  double squares = 0;
  for (const double error : errors) squares += (error - held.mean) * (error - held.mean);
  held.spread = std::sqrt(squares / static_cast<double>(errors.size() - 1));
  return held;
}

// What a form leaves. `usual`: on materials at their recommended amplitudes only.
struct Score {
  std::vector<double> constants;  // fitted to all maps
  AlbedoErrors errors{};          // mean over the maps
  double usual = 0, worst = 0;
  std::string worst_map;
  double own = 0;  // fitted to each map itself
  Held held, held_usual;
};

double mean_error(const Form& form, const std::vector<double>& constants, const Maps& maps, bool usual) {
  double sum = 0, count = 0;
  for (const MapTruth* map : maps) {
    if (usual && !map->usual) continue;
    sum += mean_of(errors_of(form, constants, *map)), ++count;
  }
  return sum / count;
}

Score score(const Form& form, const Maps& maps, const std::vector<Split>& splits) {
  Score result;
  result.constants = fit(form, maps);
  result.usual = mean_error(form, result.constants, maps, true);
  for (const MapTruth* map : maps) {
    const AlbedoErrors errors = errors_of(form, result.constants, *map);
    for (size_t a = 0; a < errors.size(); ++a)
      result.errors[a] += errors[a] / static_cast<double>(maps.size());
    if (mean_of(errors) > result.worst) result.worst = mean_of(errors), result.worst_map = map->name;
    result.own += mean_of(errors_of(form, fit(form, Maps{map}), *map)) / static_cast<double>(maps.size());
  }
  std::vector<double> held, held_usual;
  for (const Split& split : splits) {
    const std::vector<double> constants = fit(form, split.fitted);
    held.push_back(mean_error(form, constants, split.held, false));
    held_usual.push_back(mean_error(form, constants, split.held, true));
  }
  result.held = held_of(held), result.held_usual = held_of(held_usual);
  return result;
}

void print_row(const Form& form, const Score& score) {
  std::string constants;
  for (const double c : score.constants)
    constants += fmt::format("{}{:.3f}", constants.empty() ? "" : ", ", c);
  fmt::print("| {} | {} | {} | {:.4f} | {:.4f} ± {:.4f} | {:.4f} | {:.4f} ± {:.4f} | {:.3f} {} | {:.4f} |",
             form.inputs, form.formula, constants, mean_of(score.errors), score.held.mean, score.held.spread,
             score.usual, score.held_usual.mean, score.held_usual.spread, score.worst, score.worst_map,
             score.own);
  for (const double error : score.errors) fmt::print(" {:.4f} |", error);
  fmt::print("\n");
}

// Prints every form: fitted to all maps, held out, on the usual amplitudes, and fitted to each map itself.
void print_forms(const std::vector<MapTruth>& truths) {
  Maps maps;
  for (const MapTruth& map : truths) maps.push_back(&map);
  const std::vector<Split> splits = split_kinds(truths);
  const std::vector<Form> list = forms();
  std::vector<Score> scores(list.size());
  parallel_for(list.size(), 1, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) scores[i] = score(list[i], maps, splits);
  });
  fmt::print(
      "\n| input | g | constants | all maps | held | usual | usual, held | worst map | own | ρ .2 | .5 | .8 "
      "| "
      ".9 | .95 |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (size_t i = 0; i < list.size(); ++i) print_row(list[i], scores[i]);
}

}  // namespace
}  // namespace hemibake

int main(int argc, char** argv) {
  const int side = argc > 1 ? std::atoi(argv[1]) : 96, azimuths = argc > 2 ? std::atoi(argv[2]) : 32;
  const auto maps = hemibake::bake_truths(side, azimuths, argc > 3 ? argv[3] : "");
  hemibake::print_textures(maps);
  hemibake::print_albedo(maps);
  hemibake::print_forms(maps);
}
