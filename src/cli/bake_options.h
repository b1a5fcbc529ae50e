// The options of a bake, shared by the commands that bake.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "surface/surface.h"
#include "tracers/ray_options.h"

namespace CLI {
class App;
}

namespace hemibake {

struct BakeOptions {
  std::filesystem::path map;
  std::string channel;  // empty: green, or the only one
  double size_m = 1;
  double amplitude_m = 0.1;
  std::filesystem::path normal_map;
  std::string normal_y;                  // "up", "down"; required with a normal map
  std::string normals_from = "heights";  // "heights", "faces"
  std::string edge = "wrap";
  std::string tracer = "embree";
  int rays = 256;
  double cone_degrees = 180;
  std::string directions = "uniform";
  std::string patches = "facets";
  std::string texel_links = "bilinear";
  std::optional<double> max_distance_m;
  int bounces = 20;
  std::optional<double> converge;
  int max_bounces = 2000;
  std::vector<std::string> outputs = {"ao", "irradiance", "bent", "normal"};
  std::filesystem::path links;
  std::optional<double> memory_gib;
  uint64_t seed = 0;

  bool wants(const std::string& output) const;
  bool needs_links() const;  // bounces, or a links file
};

// Declares them on `app`: one definition per option.
void add_bake_options(CLI::App& app, BakeOptions& options);

// What no single option can know: throws InputError for combinations that make no sense.
void check_bake_options(const BakeOptions& options);

// Fails before the work where `output` cannot be written, or is what the bake reads. suffixes: see
// io/output_file.h.
void check_bake_output(const BakeOptions& options, const std::filesystem::path& output,
                       std::initializer_list<std::string_view> suffixes = {});

RayOptions ray_options(const BakeOptions& options);
Edge edge_of(const BakeOptions& options);

}  // namespace hemibake
