#include "cli/bake_surface.h"

#include <fmt/format.h>

#include <algorithm>

#include "cli/name_file.h"
#include "core/error.h"
#include "io/image_io.h"
#include "surface/filter.h"
#include "surface/normals.h"
#include "tracers/embree/embree.h"
#include "tracers/march/march.h"
#include "tracers/slice/slice.h"

namespace hemibake {
namespace {

// The file `provenance[path_key]` names, if it is still the one with the hash recorded.
std::filesystem::path find_input(const Provenance& provenance, const char* path_key, const char* hash_key,
                                 const std::filesystem::path& bake_path) {
  if (!provenance.contains(path_key) || !provenance.contains(hash_key))
    throw InputError(bake_path.string() +
                     ": it does not say what it was made from, expected a bake of this version");
  const std::filesystem::path recorded = provenance[path_key].get<std::string>();
  const std::filesystem::path places[] = {recorded, bake_path.parent_path() / recorded,
                                          bake_path.parent_path() / recorded.filename()};
  for (const auto& place : places) {
    if (!std::filesystem::is_regular_file(place)) continue;
    if (sha256_of_file(place) != provenance[hash_key].get<std::string>())
      throw InputError(place.string() +
                       ": not the file the bake was made from, expected its SHA-256 to be the same");
    return place;
  }
  throw InputError(
      fmt::format("{}: the map of this bake is not there, expected it beside the bake or where it was",
                  recorded.string()));
}

}  // namespace

BakeMap load_bake_map(const BakeOptions& options) {
  BakeMap map;
  Grid<float> heights = read_height_map(options.map, options.channel);
  map.surface = with_file_context(options.map, [&] {
    if (options.filter_radius > 0)
      heights = bilateral_filter(heights, filter_options(options), edge_of(options));
    map.lowest_m = options.amplitude_m * static_cast<double>(*std::ranges::min_element(heights.values));
    return make_surface(std::move(heights), options.size_m, options.amplitude_m, edge_of(options));
  });
  Surface& surface = map.surface;
  if (!options.normal_map.empty()) {
    const auto encoded = read_normal_map(options.normal_map, surface.width(), surface.height());
    const NormalY convention = options.normal_y == "up" ? NormalY::kUp : NormalY::kDown;
    surface.normals =
        with_file_context(options.normal_map, [&] { return decode_normal_map(encoded, convention); });
    if (options.normal_length == "stored") map.normal_lengths = normal_map_lengths(encoded);
  } else if (options.normals_from == "faces") {
    surface.normals = angle_weighted_normals(surface);
  }
  return map;
}

std::unique_ptr<Tracer> make_tracer(const BakeOptions& options, const BakeMap& map) {
  if (options.tracer == "embree") return make_embree_tracer(map.surface, ray_options(options));
  if (options.tracer == "slice") return make_slice_tracer(map.surface, slice_options(options));
  MarchOptions march = march_options(options);
  march.lowest_m = map.lowest_m;
  march.normal_lengths = map.normal_lengths;
  return make_march_tracer(map.surface, std::move(march));
}

size_t tracer_bytes(const BakeOptions& options, const Surface& surface) {
  if (options.tracer == "embree") return embree_scene_bytes(surface);
  if (options.tracer == "slice")
    return slice_tracer_bytes(surface, slice_options(options), options.needs_links());
  return size_t{8} * surface.texel_count();
}

void record_map_options(const BakeOptions& options, Provenance& p) {
  p["input_path"] = valid_utf8(options.map.string());
  p["size_m"] = options.size_m;
  p["amplitude_m"] = options.amplitude_m;
  p["edge"] = options.edge;
  p["channel"] = options.channel;
  p["filter_radius"] = options.filter_radius;
  if (options.filter_radius > 0) {
    p["filter_tolerance"] = options.filter_tolerance;
    p["filter_sum"] = options.filter_sum;
  }
  p["normals"] = options.normal_map.empty() ? "from " + options.normals_from : "from map";
  if (options.normal_map.empty()) return;
  p["normals_path"] = valid_utf8(options.normal_map.string());
  p["normals_sha256"] = sha256_of_file(options.normal_map);
  p["normal_y"] = options.normal_y;
}

BakeOptions map_options_from(const Provenance& p, const std::filesystem::path& bake_path) {
  BakeOptions options;
  options.map = find_input(p, "input_path", "input_sha256", bake_path);
  try {
    options.size_m = p.at("size_m").get<double>();
    options.amplitude_m = p.at("amplitude_m").get<double>();
    options.edge = p.at("edge").get<std::string>();
    options.channel = p.at("channel").get<std::string>();
    options.filter_radius = p.at("filter_radius").get<double>();
    options.filter_tolerance = p.value("filter_tolerance", options.filter_tolerance);
    options.filter_sum = p.value("filter_sum", options.filter_sum);
    const std::string normals = p.at("normals").get<std::string>();
    if (normals == "from map") {
      options.normal_map = find_input(p, "normals_path", "normals_sha256", bake_path);
      options.normal_y = p.at("normal_y").get<std::string>();
    } else {
      options.normals_from = normals == "from faces" ? "faces" : "heights";
    }
  } catch (const nlohmann::json::exception&) {
    throw InputError(bake_path.string() +
                     ": it does not say how it was made, expected a bake of this version");
  }
  return options;
}

}  // namespace hemibake
