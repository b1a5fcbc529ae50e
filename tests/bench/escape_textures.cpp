#include "bench/escape_textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "model/closed_forms.h"
#include "textures/bounce_map.h"

namespace hemibake {
namespace {

// How the channels are stored, in this order: chosen together, filtered, rounded. Steps are those between 0
// and 1, 0: float.
struct Storage {
  const char* name;
  int steps;
  int filter;            // box, texels a side
  int chosen_steps = 0;  // as `hemibake textures` writes bounce maps
};

constexpr Storage kStorages[] = {{"float", 0, 1},
                                 {"16 bits", 65535, 1},
                                 {"8 bits", 255, 1},
                                 {"2 ×", 0, 2},
                                 {"4 ×", 0, 4},
                                 {"8 ×", 0, 8},
                                 {"8 bits, 2 ×", 255, 2},
                                 {"8 bits, 4 ×", 255, 4},
                                 {"chosen", 0, 1, 255},
                                 {"chosen, 2 ×", 0, 2, 255},
                                 {"chosen, 4 ×", 0, 4, 255},
                                 {"chosen, 8 ×", 0, 8, 255},
                                 {"chosen, 4 × in 8 bits", 255, 4, 255}};

Grid<float> stored(const Grid<float>& plane, const Storage& storage) {
  Grid<float> result = storage.filter > 1 ? box_filtered(plane, storage.filter) : plane;
  if (storage.steps > 0)
    for (float& value : result.values)
      value = std::round(std::clamp(value, 0.0f, 1.0f) * static_cast<float>(storage.steps)) /
              static_cast<float>(storage.steps);
  return result;
}

size_t index_of(double albedo) {
  return static_cast<size_t>(std::ranges::find(kTruthAlbedos, albedo) - kTruthAlbedos.begin());
}

// A code: planes to store, and how a shader reads them.
struct Code {
  std::string name;
  double bounce_albedo;  // of a bounce map, else 0
  std::function<std::vector<Grid<float>>(const MapTruth&)> planes;
  std::function<double(const std::vector<Grid<float>>&, size_t, double albedo)> total;
};

double share_of(double visibility, double bounce, double albedo) {
  const double missing = 1 - bounce;
  if (missing <= 0) return 1;
  return std::clamp((1 - albedo) * (bounce - visibility) / (albedo * missing), 0.0, 1.0);
}

std::vector<Code> codes() {
  std::vector<Code> list;
  for (const double r : {0.8, 0.85, 0.9, 0.95})
    list.push_back({fmt::format("V, E at {}", r), r,
                    [r](const MapTruth& map) {
                      return std::vector{map.visibility, map.irradiance[index_of(r)]};
                    },
                    [r](const std::vector<Grid<float>>& p, size_t i, double albedo) {
                      return bounce_map_irradiance<double>(p[0][i], p[1][i], albedo, r);
                    }});
  list.push_back({"V, g from E at 0.9", 0,
                  [](const MapTruth& map) {
                    Grid<float> share = map.visibility;
                    for (size_t i = 0; i < share.size(); ++i)
                      share[i] = static_cast<float>(
                          share_of(map.visibility[i], map.irradiance[index_of(0.9)][i], 0.9));
                    return std::vector{map.visibility, share};
                  },
                  [](const std::vector<Grid<float>>& p, size_t i, double albedo) {
                    return escape_irradiance<double, double>(p[0][i], p[1][i], albedo);
                  }});
  list.push_back(
      {"V, E at 0.5, 0.9", 0,
       [](const MapTruth& map) {
         return std::vector{map.visibility, map.irradiance[index_of(0.5)], map.irradiance[index_of(0.9)]};
       },
       [](const std::vector<Grid<float>>& p, size_t i, double albedo) {
         const double half = share_of(p[0][i], p[1][i], 0.5), high = share_of(p[0][i], p[2][i], 0.9);
         const double share = std::clamp(half + (high - half) * (albedo - 0.5) / 0.4, 0.0, 1.0);
         return escape_irradiance<double, double>(p[0][i], share, albedo);
       }});
  return list;
}

std::vector<Grid<float>> chosen_planes(const Code& code, const MapTruth& map, int steps) {
  static_assert(kModelAlbedos == kBounceMapAlbedos.size());
  const LightOfTexel light = [&](size_t i) {
    MappedLight texel{map.visibility[i], map.irradiance[index_of(code.bounce_albedo)][i], {}};
    for (size_t a = 0; a < kModelAlbedos; ++a) texel.irradiance[a] = map.irradiance[a][i];
    return texel;
  };
  BounceMap chosen =
      choose_bounce_map(map.visibility.width, map.visibility.height, steps, code.bounce_albedo, light);
  return {std::move(chosen.visibility), std::move(chosen.bounce)};
}

// What a code leaves, over maps and the model albedos.
struct Left {
  double mean = 0, worst = 0, largest = 0, deep = 0;
  std::string worst_map;
  std::array<double, kTruthAlbedos.size()> by_albedo{};
  std::vector<float> errors;  // absolute, of all texels
};

double root_mean(double squares, size_t count) {
  return count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0;
}

Left measure(const Code& code, const Storage& storage, const std::vector<MapTruth>& maps) {
  constexpr double kDeep = 0.1;
  Left left;
  double deep_squares = 0;
  size_t deep_count = 0;
  for (const MapTruth& map : maps) {
    std::vector<Grid<float>> planes =
        storage.chosen_steps > 0 ? chosen_planes(code, map, storage.chosen_steps) : code.planes(map);
    for (Grid<float>& plane : planes) plane = stored(plane, storage);
    const Grid<float> escape = box_filtered(map.escape, storage.filter);
    double map_mean = 0;
    for (size_t a = 0; a < kTruthAlbedos.size(); ++a) {
      const Grid<float> truth = box_filtered(map.irradiance[a], storage.filter);
      double squares = 0;
      for (size_t i = 0; i < truth.size(); ++i) {
        const double error = code.total(planes, i, kTruthAlbedos[a]) - truth[i];
        squares += error * error;
        if (a >= kModelAlbedos) continue;
        left.errors.push_back(static_cast<float>(std::abs(error)));
        if (escape[i] < kDeep) deep_squares += error * error, ++deep_count;
      }
      const double rms = root_mean(squares, truth.size());
      left.by_albedo[a] += rms / static_cast<double>(maps.size());
      if (a < kModelAlbedos) map_mean += rms / kModelAlbedos;
    }
    left.mean += map_mean / static_cast<double>(maps.size());
    if (map_mean > left.worst) left.worst = map_mean, left.worst_map = map.name;
  }
  left.deep = root_mean(deep_squares, deep_count);
  left.largest = *std::ranges::max_element(left.errors);
  return left;
}

double percentile(std::vector<float> values, double share) {
  const auto nth = values.begin() + static_cast<long>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, nth);
  return *nth;
}

}  // namespace

Grid<float> box_filtered(const Grid<float>& plane, int n) {
  if (n == 1) return plane;
  Grid<float> result(plane.width / n, plane.height / n);
  for (int y = 0; y < result.height; ++y)
    for (int x = 0; x < result.width; ++x) {
      double sum = 0;
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) sum += plane(n * x + i, n * y + j);
      result(x, y) = static_cast<float>(sum / (n * n));
    }
  return result;
}

void print_textures(const std::vector<MapTruth>& all) {
  std::vector<MapTruth> usual;
  std::ranges::copy_if(all, std::back_inserter(usual), [](const MapTruth& map) { return map.usual; });
  fmt::print(
      "\n| channels | stored | usual | mean | worst map | 99.9 % | largest | α < .1 | ρ .2 | .5 | .8 | .9 | "
      ".95 | "
      ".85 |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const Code& code : codes()) {
    for (const Storage& storage : kStorages) {
      if (storage.chosen_steps > 0 && code.bounce_albedo == 0) continue;
      const Left left = measure(code, storage, all);
      fmt::print("| {} | {} | {:.4f} | {:.4f} | {:.4f} {} | {:.3f} | {:.3f} | {:.4f} |", code.name,
                 storage.name, measure(code, storage, usual).mean, left.mean, left.worst, left.worst_map,
                 percentile(left.errors, 0.999), left.largest, left.deep);
      for (const double error : left.by_albedo) fmt::print(" {:.4f} |", error);
      fmt::print("\n");
    }
  }
}

}  // namespace hemibake
