#include "cli/bake_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <limits>

#include "cli/validators.h"
#include "core/error.h"
#include "io/output_file.h"

namespace hemibake {
namespace {

// Azimuths and rays that serve most maps: README.
constexpr int kDefaultAzimuths = 64, kDefaultRays = 256;
constexpr int kMaxRays = 1 << 20;
constexpr int kMaxStoredBounces = 1000;
constexpr int kMaxBounces = 1000000;
constexpr int kMaxAzimuths = 65536;
constexpr int kMaxSteps = 10000000;
constexpr double kLargestLengthM = 1e9;

}  // namespace

bool BakeOptions::wants(const std::string& output) const {
  return std::ranges::find(outputs, output) != outputs.end();
}

bool BakeOptions::needs_links() const {
  return !links.empty() || (wants("irradiance") && (bounces > 0 || converge));
}

void add_surface_options(CLI::App& app, BakeOptions& options) {
  app.add_option("MAP", options.map, "height map: PNG, TIFF, EXR or anything else OpenImageIO reads")
      ->required();
  app.add_option("--channel", options.channel,
                 "channel of the map to take, by name or index; default: green, or the only one");

  app.add_option("--size", options.size_m, "length of the map's longer side, m")
      ->check(positive_to(kLargestLengthM))
      ->capture_default_str()
      ->group("Surface");
  app.add_option("--amplitude", options.amplitude_m, "height of map value 1 over 0, m")
      ->check(number_in(0, kLargestLengthM))
      ->capture_default_str()
      ->group("Surface");
  app.add_option("--edge", options.edge,
                 "beyond the border: the map again for ever (wrap), or nothing (open)")
      ->check(CLI::IsMember({"wrap", "open"}))
      ->capture_default_str()
      ->group("Surface");
  app.add_option("--normals", options.normal_map, "normal map of the same size; needs --normal-y")
      ->option_text("FILE")
      ->group("Surface");
  app.add_option(
         "--normal-y", options.normal_y,
         "green of the normal map grows against the image rows (up, OpenGL) or along them (down, DirectX)")
      ->check(CLI::IsMember({"up", "down"}))
      ->group("Surface");
  app.add_option("--normals-from", options.normals_from,
                 "without a normal map: central differences of the heights, or angle-weighted faces")
      ->check(CLI::IsMember({"heights", "faces"}))
      ->capture_default_str()
      ->group("Surface");
}

void add_bake_options(CLI::App& app, BakeOptions& options) {
  add_surface_options(app, options);
  app.add_option("--tracer", options.tracer,
                 "how visibility is found: vertical slices (default), rays with Embree (default with --cone, "
                 "--directions or over 65536 --rays, which slices do not have), or the texel march of 2018")
      ->check(CLI::IsMember({"embree", "march", "slice"}))
      ->group("Tracing");
  app.add_option("--rays", options.rays,
                 "azimuths of slices per texel (default 64), or rays per texel and per patch (default 256)")
      ->check(whole_number_in(1, kMaxRays))
      ->group("Tracing");
  app.add_option("--cone", options.cone_degrees,
                 "full aperture of the texels' rays about the normal, degrees")
      ->check(positive_to(180))
      ->capture_default_str()
      ->group("Tracing");
  app.add_option("--directions", options.directions,
                 "spread of the texels' rays: equal solid angles (default), or equal shares of irradiance")
      ->check(CLI::IsMember({"uniform", "cosine"}))
      ->group("Tracing");
  app.add_option("--max-distance", options.max_distance_m,
                 "hits further along the ray count as sky, m; default: no limit")
      ->check(positive_to(1e30))
      ->group("Tracing");
  app.add_option(
         "--target-error", options.target_error,
         "choose rays and bounces so that the rms errors of AO, E0/pi and E/pi (albedo 0.2 to 0.95) stay "
         "below this; a sample of texels is traced first, and another afterwards says what was reached")
      ->check(number_in(1e-4, 0.5))
      ->group("Tracing");
  app.add_flag("--explain", options.explain, "with --target-error: say how rays and bounces were chosen")
      ->group("Tracing");
  app.add_option("--seed", options.seed, "another number, other random rotations")
      ->check(whole_number_in(0, std::numeric_limits<uint64_t>::max()))
      ->capture_default_str()
      ->group("Tracing");

  app.add_option("--preset", options.preset,
                 "published: the experiment of 2018, all options of this group and --tracer march --rays "
                 "1024 --cone 179 "
                 "--normal-y up; any of them given too wins")
      ->check(CLI::IsMember({"published"}))
      ->group("March");
  app.add_option("--max-steps", options.max_steps,
                 "steps of a texel after which a march is sky [published: 200]")
      ->check(whole_number_in(1, kMaxSteps))
      ->capture_default_str()
      ->group("March");
  app.add_option("--lift", options.lift_percent,
                 "height of a march's start over its texel, percent of the amplitude [1]")
      ->check(number_in(0, 100))
      ->capture_default_str()
      ->group("March");
  app.add_option("--filter-radius", options.filter_radius,
                 "bilateral filter of the heights first, texels; 0: none [1]")
      ->check(number_in(0, 16))
      ->capture_default_str()
      ->group("March");
  app.add_option("--filter-tolerance", options.filter_tolerance, "its range, in map values 0..1 [0.2]")
      ->check(positive_to(1e6))
      ->capture_default_str()
      ->group("March");
  app.add_option("--filter-sum", options.filter_sum,
                 "its whole kernel, or the part the published shader adds up [published]")
      ->check(CLI::IsMember({"all", "published"}))
      ->capture_default_str()
      ->group("March");
  app.add_option("--ray-set", options.ray_set,
                 "turned per texel, or one set for all as published [published]")
      ->check(CLI::IsMember({"rotated", "published"}))
      ->capture_default_str()
      ->group("March");
  app.add_option("--lookup", options.lookup,
                 "heights between texels: bilinear, or as the published sampler did [published]")
      ->check(CLI::IsMember({"bilinear", "published"}))
      ->capture_default_str()
      ->group("March");
  app.add_option("--normalize", options.normalize,
                 "weights that sum to 1, or 2 cos/N as published [published]")
      ->check(CLI::IsMember({"exact", "published"}))
      ->capture_default_str()
      ->group("March");
  app.add_option("--normal-length", options.normal_length,
                 "rays follow unit normals, or the map's as stored [stored]")
      ->check(CLI::IsMember({"unit", "stored"}))
      ->capture_default_str()
      ->group("March");

  app.add_option("--patches", options.patch_kind,
                 "what re-emits light: the surface's triangles (default), or the texels (as published in "
                 "2018; the only ones of march)")
      ->check(CLI::IsMember({"facets", "texels"}))
      ->group("Light");
  app.add_option("--texel-links", options.texel_links,
                 "with --patches texels: a hit links to the nearest texel or to four")
      ->check(CLI::IsMember({"bilinear", "nearest"}))
      ->capture_default_str()
      ->group("Light");
  app.add_option("--bounces", options.bounces, "bounces stored one by one")
      ->check(whole_number_in(0, kMaxStoredBounces))
      ->capture_default_str()
      ->group("Light");
  app.add_option(
         "--converge", options.converge,
         "go on, into the total only, until less than this share of pi is under way in the worst texel")
      ->check(number_in(1e-12, 1))
      ->group("Light");
  app.add_option("--max-bounces", options.max_bounces, "where --converge gives up")
      ->check(whole_number_in(1, kMaxBounces))
      ->capture_default_str()
      ->group("Light");

  app.add_option("--outputs", options.outputs,
                 "planes to write, separated by commas; links are traced only for irradiance with bounces, "
                 "or --links")
      ->delimiter(',')
      ->check(CLI::IsMember({"ao", "irradiance", "bent", "normal"}))
      ->capture_default_str()
      ->group("Output");
  app.add_option("--links", options.links, "write the form-factor links too, HDF5")
      ->option_text("FILE.h5")
      ->group("Output");
  app.add_option("--memory", options.memory_gib,
                 "links that need more go to a temporary file beside the output, a bake that still does is "
                 "refused, GiB; default: what the machine has")
      ->check(positive_to(1e6))
      ->group("Output");
}

namespace {

void apply_published_preset(const CLI::App& app, BakeOptions& options) {
  const auto set = [&app](const char* name, auto& option, const auto& value) {
    if (app.get_option(name)->count() == 0) option = value;
  };
  const MarchOptions march = mayaux2018_march();
  const FilterOptions filter = mayaux2018_filter();
  set("--tracer", options.tracer, "march");
  set("--rays", options.rays, march.rays);
  set("--cone", options.cone_degrees, march.cone_degrees);
  set("--max-steps", options.max_steps, march.max_steps);
  set("--lift", options.lift_percent, march.lift_percent);
  set("--filter-radius", options.filter_radius, filter.radius);
  set("--filter-tolerance", options.filter_tolerance, filter.tolerance);
  set("--filter-sum", options.filter_sum, "published");
  set("--ray-set", options.ray_set, "published");
  set("--lookup", options.lookup, "published");
  set("--normalize", options.normalize, "published");
  if (options.normal_map.empty()) return;
  set("--normal-length", options.normal_length, "stored");
  set("--normal-y", options.normal_y, "up");
}

}  // namespace

void settle_bake_options(const CLI::App& app, BakeOptions& options) {
  if (options.preset == "published") apply_published_preset(app, options);
  if (options.tracer.empty()) {
    const bool asks_for_rays =
        options.cone_degrees < 180 || !options.directions.empty() || options.rays > kMaxAzimuths;
    options.tracer = asks_for_rays ? "embree" : "slice";
  }
  if (options.directions.empty()) options.directions = "uniform";
  if (options.rays == 0) options.rays = options.tracer == "slice" ? kDefaultAzimuths : kDefaultRays;
  if (options.patch_kind.empty()) options.patch_kind = options.tracer == "march" ? "texels" : "facets";

  if (options.target_error) {
    if (options.tracer == "march")
      throw InputError(
          "--target-error: a march has errors that rays do not mend, expected --tracer embree or slice");
    if (options.max_distance_m || options.cone_degrees < 180)
      throw InputError(
          "--target-error: is against the whole hemisphere, expected neither --max-distance nor --cone");
    for (const char* chosen : {"--rays", "--bounces"})
      if (app.get_option(chosen)->count() > 0)
        throw InputError(std::string(chosen) + ": is chosen by --target-error, expected one of the two");
  } else if (options.explain) {
    throw InputError("--explain: explains --target-error, expected it too");
  }
  if (options.tracer == "march" && options.patch_kind == "facets")
    throw InputError("--patches: a march knows no facets, expected texels with --tracer march");
  if (options.tracer == "slice" && options.rays > kMaxAzimuths)
    throw InputError(fmt::format("--rays: {} azimuths, expected at most {} with --tracer slice", options.rays,
                                 kMaxAzimuths));
  if (options.tracer == "slice" && options.cone_degrees < 180)
    throw InputError("--cone: slices serve the whole hemisphere, expected 180 with --tracer slice");
  if (!options.normal_map.empty() && options.normal_y.empty())
    throw InputError(
        options.normal_map.string() +
        ": the direction of its green channel is not known, expected --normal-y up or --normal-y down");
  if (options.normal_map.empty() && !options.normal_y.empty())
    throw InputError("--normal-y: there is no normal map, expected --normals FILE with it");
  if (!options.normal_map.empty() && options.normals_from != "heights")
    throw InputError("--normals-from: normals come from --normals already, expected one of the two");
  if (options.normal_length == "stored" && (options.normal_map.empty() || options.tracer != "march"))
    throw InputError("--normal-length: stored lengths need --normals and --tracer march, expected both");
  if (options.converge && !options.wants("irradiance"))
    throw InputError("--converge: irradiance is not among --outputs, expected it there");
}

void check_bake_output(const BakeOptions& options, const std::filesystem::path& output,
                       std::initializer_list<std::string_view> suffixes) {
  check_output_path(output, suffixes);
  for (const std::filesystem::path& input : {options.map, options.normal_map}) {
    std::error_code not_there;
    if (std::filesystem::equivalent(output, input, not_there))
      throw InputError(output.string() + ": is the input itself, expected another name for the output");
  }
}

RayOptions ray_options(const BakeOptions& options) {
  RayOptions rays;
  rays.rays = options.rays;
  rays.cone_degrees = options.cone_degrees;
  if (options.max_distance_m) rays.max_distance_m = *options.max_distance_m;
  rays.directions = options.directions == "cosine" ? DirectionSet::kCosine : DirectionSet::kUniform;
  rays.patch_kind = patches_of(options);
  rays.texel_links = options.texel_links == "nearest" ? TexelLinks::kNearest : TexelLinks::kBilinear;
  rays.seed = options.seed;
  return rays;
}

SliceOptions slice_options(const BakeOptions& options) {
  SliceOptions slice;
  slice.azimuths = options.rays;
  if (options.max_distance_m) slice.max_distance_m = *options.max_distance_m;
  slice.patch_kind = patches_of(options);
  slice.texel_links = ray_options(options).texel_links;
  slice.seed = options.seed;
  return slice;
}

FilterOptions filter_options(const BakeOptions& options) {
  return {options.filter_radius, options.filter_tolerance,
          options.filter_sum == "published" ? FilterSum::kMayaux2018 : FilterSum::kAll};
}

MarchOptions march_options(const BakeOptions& options) {
  MarchOptions march;
  march.rays = options.rays;
  march.cone_degrees = options.cone_degrees;
  if (options.max_distance_m) march.max_distance_m = *options.max_distance_m;
  march.max_steps = options.max_steps;
  march.lift_percent = options.lift_percent;
  march.ray_set = options.ray_set == "published" ? MarchRays::kMayaux2018 : MarchRays::kRotated;
  march.weights = options.normalize == "published" ? MarchWeights::kMayaux2018 : MarchWeights::kExact;
  march.lookup = options.lookup == "published" ? MarchLookup::kMayaux2018 : MarchLookup::kBilinear;
  march.seed = options.seed;
  march.amplitude_m = options.amplitude_m;
  return march;
}

PatchKind patches_of(const BakeOptions& options) {
  return options.patch_kind == "facets" ? PatchKind::kFacets : PatchKind::kTexels;
}

Edge edge_of(const BakeOptions& options) { return options.edge == "wrap" ? Edge::kWrap : Edge::kOpen; }

}  // namespace hemibake
