#include "bench/escape_truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "bake/bake.h"
#include "core/constants.h"
#include "core/parallel.h"
#include "lighting/albedo.h"
#include "surface/synthetic/noise.h"
#include "surface/synthetic/synthetic.h"
#include "transport/albedo_light.h"

namespace hemibake {
namespace {

constexpr double kTolerance = 1e-5;  // of a patch's light, over the largest direct light

// A map to bake: a kind at an amplitude and seed, or a file.
struct MapPlan {
  std::string kind;
  double amplitude_m;
  uint64_t seed = 1;
  std::filesystem::path file = {}, normal_map = {};
  bool painted = false;

  bool usual() const { return seed == 1 && kind != "groove" && kind != "bowl"; }
  std::string name() const {
    return fmt::format("{}{} {:g} m{}", file.empty() ? "" : "file ", kind, amplitude_m,
                       normal_map.empty() ? "" : ", its normal map");
  }
};

std::vector<MapPlan> plan_maps() {
  const std::filesystem::path reference = HEMIBAKE_REFERENCE_DIR, maps = HEMIBAKE_SOURCE_DIR "/heightmaps";
  std::vector<MapPlan> plans = {
      {"cobbles", 0.06, 1, {}, {}, true},
      {"cobbles", 0.15, 2},
      {"gravel", 0.08, 1, {}, {}, true},
      {"gravel", 0.04, 2},
      {"planks", 0.05, 1},
      {"planks", 0.12, 2},
      {"tiles", 0.04, 1, {}, {}, true},
      {"tiles", 0.12, 2},
      {"weave", 0.08, 1},
      {"weave", 0.2, 2},
      {"mud", 0.07, 1, {}, {}, true},
      {"mud", 0.15, 2},
      {"stairs", 0.3, 1, {}, {}, true},
      {"stairs", 0.12, 2},
      {"trenches", 0.12, 1, {}, {}, true},
      {"trenches", 0.3, 2},
      {"dunes", 0.08, 1},
      {"dunes", 0.25, 2},
      {"terrain", 0.25, 1, {}, {}, true},
      {"terrain", 0.5, 2},
      {"bricks", 0.05, 2, {}, {}, true},
      {"shapes", 0.2, 2, {}, {}, true},
      {"concrete", 0.15, 2},
      {"noise", 0.3, 2, {}, {}, true},
      {"groove", 0.25, 1},
      {"bowl", 0.35, 1},
      {"bricks", 0.1, 1, maps / "bricks.png"},
      {"shapes", 0.45, 1, maps / "shapes.png"},
      {"concrete", 0.05, 1, maps / "concrete.png"},
      {"noise", 0.1, 1, maps / "noise.png"},
  };
  if (std::filesystem::exists(reference / "WallHeight.png")) {
    plans.push_back({"wall", 0.1, 1, reference / "WallHeight.png"});
    plans.push_back({"wall", 0.1, 1, reference / "WallHeight.png", reference / "WallNormal.png"});
  }
  return plans;
}

LoadedMap make_map(const MapPlan& plan, int side) {
  LoadedMap map;
  map.amplitude_m = plan.amplitude_m;
  if (plan.file.empty()) {
    const SyntheticKindInfo& info =
        *std::ranges::find(synthetic_kinds(), plan.kind, &SyntheticKindInfo::name);
    SyntheticMap made =
        synthesize(info.kind, {.width = side, .height = side, .seed = plan.seed, .angle_rad = {}});
    map.surface = make_surface(std::move(made.heights), 1, plan.amplitude_m, Edge::kWrap);
    return map;
  }
  MapSettings settings;
  settings.map = plan.file;
  settings.amplitude_m = plan.amplitude_m;
  if (!plan.normal_map.empty()) {
    settings.normals_from = NormalSource::kMap;
    settings.normal_map = plan.normal_map;
    settings.normal_y = NormalY::kDown;
  }
  return load_map(settings);
}

constexpr std::array kPatterns = {"checks", "noise", "stripes", "blotches"};

// Returns the albedo of a pattern at a point of the map, 0.05..0.95.
double pattern_albedo(const std::string& pattern, double x, double y) {
  if (pattern == "checks")
    return (static_cast<int>(std::floor(8 * x)) + static_cast<int>(std::floor(8 * y))) % 2 == 0 ? 0.9 : 0.1;
  if (pattern == "noise") {
    const FractalNoise noise{.frequency = 6, .highest_frequency = 48, .gain = 0.7, .seed = 17};
    return std::clamp(0.5 + 0.8 * fractal_noise(x, y, {}, noise), 0.05, 0.95);
  }
  if (pattern == "stripes") return 0.5 + 0.4 * std::sin(2 * kPi * (5 * x + 3 * y));
  return 0.05 + 0.9 * hash_unit(voronoi_cell(x, y, {}, 11, 1, 23).bits, 0, 5);
}

Grid<float> paint(const std::string& pattern, int width, int height) {
  Grid<float> albedo(width, height);
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i)
      albedo(i, j) = static_cast<float>(pattern_albedo(pattern, (i + 0.5) / width, (j + 0.5) / height));
  return albedo;
}

Grid<float> solve(const LightTransport& transport, const std::vector<float>& albedo) {
  AlbedoOptions options;
  options.tolerance = kTolerance;
  const AlbedoLight light = bounce_with_albedo(transport, albedo, options);
  Grid<float> plane(transport.direct_over_pi.width, transport.direct_over_pi.height);
  std::ranges::transform(light.texel_light, plane.values.begin(),
                         [](double value) { return static_cast<float>(std::min(value, 1.0)); });
  return plane;
}

void add_painted(const LoadedMap& map, const LightTransport& transport, MapTruth& truth) {
  const PatchSet patches = make_patches(map.surface, PatchKind::kFacets);
  for (const std::string pattern : kPatterns) {
    PaintedTruth painted{pattern, paint(pattern, map.surface.width(), map.surface.height()), {}};
    Albedo albedo;
    albedo.map = Grid<glm::vec3>(map.surface.width(), map.surface.height());
    for (size_t i = 0; i < albedo.map.size(); ++i) albedo.map[i] = glm::vec3(painted.albedo[i]);
    const std::vector<glm::vec3> of_patches = albedo_of_patches(map.surface, albedo, patches);
    std::vector<float> reflectance(of_patches.size());
    std::ranges::transform(of_patches, reflectance.begin(), [](const glm::vec3& rgb) { return rgb.x; });
    painted.irradiance = solve(transport, reflectance);
    truth.painted.push_back(std::move(painted));
  }
}

MapTruth bake_truth(const MapPlan& plan, int side, int azimuths) {
  const LoadedMap map = make_map(plan, side);
  MapSettings map_settings;
  BakeSettings settings;
  settings.rays = azimuths;
  settings.bounces = 1;
  settings.keep_transport = true;
  resolve_defaults(map_settings, settings, [](const std::string& name) { return name == "rays"; });
  const BakeResult baked = bake(map, settings, Context{});
  const LightTransport& transport = *baked.transport;
  MapTruth truth;
  truth.name = plan.name(), truth.kind = plan.kind, truth.usual = plan.usual();
  truth.height_range_texels = height_range_m(map.surface) / map.surface.texel_size_m;
  truth.visibility = transport.direct_over_pi;
  truth.escape = baked.planes.visible_fraction;
  truth.normal_z = Grid<float>(map.surface.width(), map.surface.height());
  for (size_t i = 0; i < truth.size(); ++i) truth.normal_z[i] = map.surface.normals[i].z;
  const size_t patches = transport.bounce_matrix().rows;
  for (size_t k = 0; k < kTruthAlbedos.size(); ++k)
    truth.irradiance[k] = solve(transport, std::vector<float>(patches, static_cast<float>(kTruthAlbedos[k])));
  if (plan.painted) add_painted(map, transport, truth);
  return truth;
}

// Calls visit(plane) for every plane of a map, in the order of its file.
template <class Visit>
void visit_planes(MapTruth& truth, const Visit& visit) {
  visit(truth.visibility), visit(truth.escape), visit(truth.normal_z);
  for (Grid<float>& plane : truth.irradiance) visit(plane);
  for (PaintedTruth& painted : truth.painted) visit(painted.albedo), visit(painted.irradiance);
}

void keep(MapTruth& truth, const std::filesystem::path& path) {
  std::ofstream file(path, std::ios::binary);
  file << truth.visibility.width << ' ' << truth.visibility.height << ' ' << truth.height_range_texels
       << '\n';
  visit_planes(truth, [&](Grid<float>& plane) {
    file.write(reinterpret_cast<const char*>(plane.values.data()),
               static_cast<std::streamsize>(plane.size() * sizeof(float)));
  });
}

bool take_kept(const MapPlan& plan, const std::filesystem::path& path, MapTruth& truth) {
  std::ifstream file(path, std::ios::binary);
  int width = 0, height = 0;
  if (!(file >> width >> height >> truth.height_range_texels)) return false;
  file.ignore();
  truth.name = plan.name(), truth.kind = plan.kind, truth.usual = plan.usual();
  if (plan.painted)
    for (const std::string pattern : kPatterns) truth.painted.push_back({pattern, {}, {}});
  visit_planes(truth, [&](Grid<float>& plane) {
    plane = Grid<float>(width, height);
    file.read(reinterpret_cast<char*>(plane.values.data()),
              static_cast<std::streamsize>(plane.size() * sizeof(float)));
  });
  return static_cast<bool>(file);
}

}  // namespace

std::vector<MapTruth> bake_truths(int side, int azimuths, const std::filesystem::path& folder) {
  std::vector<MapTruth> truths;
  if (!folder.empty()) std::filesystem::create_directories(folder);
  for (const MapPlan& plan : plan_maps()) {
    const std::filesystem::path path =
        folder / fmt::format("{}_{}_{}{}_{}_{}.planes", plan.kind, plan.amplitude_m, plan.seed,
                             plan.normal_map.empty() ? "" : "_normals", plan.file.empty() ? side : 0,
                             azimuths);
    MapTruth truth;
    const bool kept = !folder.empty() && take_kept(plan, path, truth);
    const double start = process_cpu_seconds();
    if (!kept) truth = bake_truth(plan, side, azimuths);
    if (!kept && !folder.empty()) keep(truth, path);
    fmt::print(stderr, "{:32} {:4} x {:<4} {:6.1f} cpu-s\n", truth.name, truth.visibility.width,
               truth.visibility.height, process_cpu_seconds() - start);
    truths.push_back(std::move(truth));
  }
  return truths;
}

}  // namespace hemibake
