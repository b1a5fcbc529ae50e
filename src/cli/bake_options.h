// The options of a bake, shared by the commands that bake.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "surface/filter.h"
#include "surface/surface.h"
#include "tracers/march/march.h"
#include "tracers/ray_options.h"
#include "tracers/slice/slice.h"

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
  std::string tracer;  // empty: slice, or embree where another option asks for rays
  int rays = 0;        // 0: what serves most maps
  double cone_degrees = 180;
  std::string directions;  // empty: uniform
  std::string patch_kind;  // empty: what the tracer has (facets, where it has both)
  std::string texel_links = "bilinear";
  std::optional<double> max_distance_m;
  std::optional<double> target_error;  // chooses rays and bounces
  bool explain = false;
  // --tracer march, and what it marches over.
  double filter_radius = 0;
  double filter_tolerance = 0.2;
  std::string filter_sum = "all";
  int max_steps = 200;
  double lift_percent = 1;
  std::string ray_set = "rotated";
  std::string lookup = "bilinear";
  std::string normalize = "exact";
  std::string normal_length = "unit";
  std::string preset;
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

// Declares them on `app`: one definition per option. The first only those that make the map a surface.
void add_surface_options(CLI::App& app, BakeOptions& options);
void add_bake_options(CLI::App& app, BakeOptions& options);

// Fills in what follows from other options: the preset (where its options were not given on the command line
// of `app`), the tracer, its rays and its patches. Then what no single option can know: throws InputError for
// combinations that make no sense.
void settle_bake_options(const CLI::App& app, BakeOptions& options);

// Fails before the work where `output` cannot be written, or is what the bake reads. suffixes: see
// io/output_file.h.
void check_bake_output(const BakeOptions& options, const std::filesystem::path& output,
                       std::initializer_list<std::string_view> suffixes = {});

RayOptions ray_options(const BakeOptions& options);
SliceOptions slice_options(const BakeOptions& options);
FilterOptions filter_options(const BakeOptions& options);
// Without what only the map knows (MarchOptions::lowest_m, normal_lengths).
MarchOptions march_options(const BakeOptions& options);
PatchKind patches_of(const BakeOptions& options);
Edge edge_of(const BakeOptions& options);

}  // namespace hemibake
