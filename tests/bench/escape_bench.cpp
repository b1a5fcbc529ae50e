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

// What a form leaves on all maps.
struct Score {
  std::vector<double> constants;
  AlbedoErrors errors{};  // mean over the maps
  double mean = 0, worst = 0, held = 0, spread = 0, held_worst = 0;
  std::string worst_map;
  double own = 0;  // fitted to each map itself
};

double mean_error(const Form& form, const std::vector<double>& constants, const Maps& maps) {
  double sum = 0;
  for (const MapTruth* map : maps) sum += mean_of(errors_of(form, constants, *map));
  return sum / static_cast<double>(maps.size());
}

Score score(const Form& form, const std::vector<MapTruth>& maps, const std::vector<Split>& splits) {
  Maps all;
  for (const MapTruth& map : maps) all.push_back(&map);
  Score result;
  result.constants = fit(form, all);
  for (const MapTruth& map : maps) {
    const AlbedoErrors errors = errors_of(form, result.constants, map);
    for (size_t a = 0; a < errors.size(); ++a)
      result.errors[a] += errors[a] / static_cast<double>(maps.size());
    if (mean_of(errors) > result.worst) result.worst = mean_of(errors), result.worst_map = map.name;
    const MapTruth* one[] = {&map};
    result.own += mean_of(errors_of(form, fit(form, one), map)) / static_cast<double>(maps.size());
  }
  result.mean = mean_of(result.errors);
  double squares = 0;
  for (const Split& split : splits) {
    const double held = mean_error(form, fit(form, split.fitted), split.held);
    result.held += held / kSplits, squares += held * held / kSplits;
  }
  result.spread = std::sqrt(std::max(0.0, squares - result.held * result.held));
  return result;
}

void print_forms(const std::vector<MapTruth>& maps) {
  const std::vector<Split> splits = split_kinds(maps);
  const std::vector<Form> list = forms();
  std::vector<Score> scores(list.size());
  setvbuf(stdout, nullptr, _IONBF, 0);
  parallel_for(list.size(), 1, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      scores[i] = score(list[i], maps, splits);
      fmt::print(stderr, "{} {:.4f} {:.4f}\n", list[i].formula, scores[i].mean, scores[i].held);
    }
  });
  fmt::print("\n| input | g | constants | all maps | held | worst map | own | ρ .2 | .5 | .8 | .9 | .95 |\n");
  fmt::print("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (size_t i = 0; i < list.size(); ++i) {
    const Score& s = scores[i];
    std::string constants;
    for (const double c : s.constants) constants += fmt::format("{}{:.3f}", constants.empty() ? "" : ", ", c);
    fmt::print("| {} | {} | {} | {:.4f} | {:.4f} ± {:.4f} | {:.3f} {} | {:.4f} |", list[i].inputs,
               list[i].formula, constants, s.mean, s.held, s.spread, s.worst, s.worst_map, s.own);
    for (const double error : s.errors) fmt::print(" {:.4f} |", error);
    fmt::print("\n");
  }
}

}  // namespace
}  // namespace hemibake

int main(int argc, char** argv) {
  const int side = argc > 1 ? std::atoi(argv[1]) : 96, azimuths = argc > 2 ? std::atoi(argv[2]) : 32;
  const auto maps = hemibake::bake_truths(side, azimuths, argc > 3 ? argv[3] : "");
  if (std::getenv("FORMS") == nullptr) hemibake::print_textures(maps), hemibake::print_albedo(maps);
  hemibake::print_forms(maps);
}
