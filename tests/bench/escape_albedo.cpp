#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "bench/escape_forms.h"
#include "bench/escape_textures.h"
#include "model/closed_forms.h"

namespace hemibake {
namespace {

constexpr double kBounceAlbedo = 0.9;
constexpr size_t kBouncePlane = 3;  // of kTruthAlbedos

// The mip chain of an albedo map that repeats: levels of half the size, as far as sides are even.
std::vector<Grid<float>> mip_chain(const Grid<float>& albedo) {
  std::vector<Grid<float>> levels = {albedo};
  while (levels.back().width % 2 == 0 && levels.back().height % 2 == 0)
    levels.push_back(box_filtered(levels.back(), 2));
  return levels;
}

double sample_level(const Grid<float>& level, double u, double v) {
  return interpolate_bilinear<double>(u * level.width - 0.5, v * level.height - 0.5, [&](int i, int j) {
    return static_cast<double>(level(wrap_index(i, level.width), wrap_index(j, level.height)));
  });
}

// Returns the albedo at a level of detail, trilinear as a GPU samples it.
double sample_mip(const std::vector<Grid<float>>& levels, double u, double v, double lod) {
  lod = std::clamp(lod, 0.0, static_cast<double>(levels.size() - 1));
  const auto low = static_cast<size_t>(lod);
  const size_t high = std::min(low + 1, levels.size() - 1);
  const double t = lod - static_cast<double>(low);
  return (1 - t) * sample_level(levels[low], u, v) + t * sample_level(levels[high], u, v);
}

// A rule for the albedo of the bounces: own · texel's + (1 − own) · mip at log₂(height range, texels) +
// shift.
struct Rule {
  double own, shift;
};

enum class Light { kVisibility, kCubic, kEscapeV, kEscapeAo, kBounceMap };

double total(Light light, const MapTruth& map, size_t i, double albedo) {
  const double v = map.visibility[i];
  switch (light) {
    case Light::kVisibility:
      return v;
    case Light::kCubic:
      return std::max(v, jimenez_cubic(v, albedo, kJimenezConstants.data()));
    case Light::kEscapeV:
      return escape_irradiance(v, v, albedo);
    case Light::kEscapeAo:
      return escape_irradiance<double, double>(v, map.escape[i], albedo);
    case Light::kBounceMap:
      return bounce_map_irradiance<double>(v, map.irradiance[kBouncePlane][i], albedo, kBounceAlbedo);
  }
  return 0;
}

constexpr Light kLights[] = {Light::kVisibility, Light::kCubic, Light::kEscapeV, Light::kEscapeAo,
                             Light::kBounceMap};

// Returns the rms error on one painted map, of every kind of light.
std::vector<double> errors_of_rule(const MapTruth& map, const PaintedTruth& painted,
                                   const std::vector<Grid<float>>& levels, Rule rule) {
  const double lod = std::log2(std::max(map.height_range_texels, 1.0)) + rule.shift;
  std::vector<double> squares(std::size(kLights));
  for (int y = 0; y < painted.albedo.height; ++y) {
    for (int x = 0; x < painted.albedo.width; ++x) {
      const size_t i = painted.albedo.index(x, y);
      const double blurred =
          sample_mip(levels, (x + 0.5) / painted.albedo.width, (y + 0.5) / painted.albedo.height, lod);
      const double albedo = rule.own * painted.albedo[i] + (1 - rule.own) * blurred;
      for (size_t k = 0; k < squares.size(); ++k) {
        const double error = total(kLights[k], map, i, albedo) - painted.irradiance[i];
        squares[k] += error * error;
      }
    }
  }
  for (double& square : squares) square = std::sqrt(square / static_cast<double>(map.size()));
  return squares;
}

// Returns the mean over the painted maps. pattern: only this one; empty: all.
std::vector<double> mean_errors(const std::vector<MapTruth>& maps, Rule rule, const std::string& pattern = "",
                                const std::string& name = "") {
  std::vector<double> sums(std::size(kLights));
  double count = 0;
  for (const MapTruth& map : maps) {
    if (!name.empty() && map.name != name) continue;
    for (const PaintedTruth& painted : map.painted) {
      if (!pattern.empty() && painted.pattern != pattern) continue;
      const std::vector<double> errors = errors_of_rule(map, painted, mip_chain(painted.albedo), rule);
      for (size_t k = 0; k < sums.size(); ++k) sums[k] += errors[k];
      ++count;
    }
  }
  for (double& sum : sums) sum /= count;
  return sums;
}

void print_row(const std::string& name, const std::vector<double>& errors) {
  fmt::print("| {} |", name);
  for (const double error : errors) fmt::print(" {:.4f} |", error);
  fmt::print("\n");
}

}  // namespace

void print_albedo(const std::vector<MapTruth>& maps) {
  constexpr Rule kOwn{1, 0}, kRule{0.25, 0};
  fmt::print(
      "\n| albedo of the bounces | E = V | cubic | g = V | g = α | V, E at 0.9 |\n"
      "| --- | --- | --- | --- | --- | --- |\n");
  print_row("the texel's own", mean_errors(maps, kOwn));
  for (const double own : {0.0, 0.125, 0.25, 0.375, 0.5})
    for (const double shift : {-2.0, -1.0, -0.5, 0.0, 0.5, 1.0})
      print_row(fmt::format("{} own, lod {:+}", own, shift), mean_errors(maps, {own, shift}));
  for (const char* pattern : {"checks", "noise", "stripes", "blotches"}) {
    print_row(fmt::format("{}: own", pattern), mean_errors(maps, kOwn, pattern));
    print_row(fmt::format("{}: rule", pattern), mean_errors(maps, kRule, pattern));
  }
  for (const MapTruth& map : maps) {
    if (map.painted.empty()) continue;
    print_row(fmt::format("{} ({:.1f} texels): own", map.name, map.height_range_texels),
              mean_errors(maps, kOwn, "", map.name));
    print_row(fmt::format("{}: rule", map.name), mean_errors(maps, kRule, "", map.name));
  }
}

}  // namespace hemibake
