#include "io/bake_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <type_traits>
#include <vector>

#include "core/constants.h"
#include "core/error.h"
#include "io/geo_place.h"
#include "io/geo_write.h"
#include "io/image_io.h"
#include "io/output_file.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

// Light above all there is that rounding, and what `check` is to judge, may make.
constexpr double kRounding = 1e-3;
constexpr double kMostGainedLight = 1e6;
constexpr double kUnitLength = 1e-3;

std::string irradiance_channel(size_t bounce) { return fmt::format("irradiance.{:02}", bounce); }

template <class Value, class Values>
void append_vector_planes(std::vector<BasicPlane<Value>>& planes, const std::string& name, Values& grid) {
  if (grid.empty()) return;
  planes.push_back({name + ".X", &grid.values[0].x, 3});
  planes.push_back({name + ".Y", &grid.values[0].y, 3});
  planes.push_back({name + ".Z", &grid.values[0].z, 3});
}

// Lists the channels of every plane that is not empty, to be written from or read into.
template <class Value, class BakeType>
std::vector<BasicPlane<Value>> planes_of(BakeType& bake) {
  std::vector<BasicPlane<Value>> planes;
  if (!bake.visible_fraction.empty()) planes.push_back({"ao", bake.visible_fraction.values.data()});
  if (!bake.visibility.empty()) planes.push_back({"visibility", bake.visibility.values.data()});
  for (size_t b = 0; b < bake.irradiance.size(); ++b)
    planes.push_back({irradiance_channel(b), bake.irradiance[b].values.data()});
  if (!bake.total.empty()) planes.push_back({"total", bake.total.values.data()});
  if (!bake.residual.empty()) planes.push_back({"residual", bake.residual.values.data()});
  if (!bake.bounce.empty()) planes.push_back({"bounce", bake.bounce.values.data()});
  append_vector_planes(planes, "normal", bake.normals);
  append_vector_planes(planes, "bent", bake.bent_normals);
  return planes;
}

template <class T>
void check_size(const Bake& bake, const Grid<T>& grid, const char* name) {
  if (grid.empty()) return;
  expect_equal(grid.width, bake.width, fmt::format("width of plane {} of a bake", name));
  expect_equal(grid.height, bake.height, fmt::format("height of plane {} of a bake", name));
}

void check_sizes(const Bake& bake) {
  check_size(bake, bake.visible_fraction, "ao");
  check_size(bake, bake.visibility, "visibility");
  check_size(bake, bake.bounce, "bounce");
  for (const Grid<float>& plane : bake.irradiance) {
    if (plane.empty()) throw std::logic_error("an irradiance plane of a bake is empty");
    check_size(bake, plane, "irradiance");
  }
  check_size(bake, bake.total, "total");
  check_size(bake, bake.residual, "residual");
  check_size(bake, bake.normals, "normal");
  check_size(bake, bake.bent_normals, "bent");
}

// Makes a bake with room for every plane that has a channel; read_planes refuses planes that are incomplete.
Bake make_room(const fs::path& path, const ImageHeader& header) {
  const auto count = [&](std::string_view start) {
    return static_cast<size_t>(
        std::count_if(header.channels.begin(), header.channels.end(),
                      [&](const std::string& channel) { return channel.starts_with(start); }));
  };
  const auto has = [&](std::string_view name) {
    return std::find(header.channels.begin(), header.channels.end(), name) != header.channels.end();
  };
  Bake bake;
  bake.width = header.width;
  bake.height = header.height;
  const auto make_plane = [&](auto& plane) {
    plane = std::remove_reference_t<decltype(plane)>(header.width, header.height);
  };
  if (has("ao")) make_plane(bake.visible_fraction);
  if (has("visibility")) make_plane(bake.visibility);
  if (has("bounce")) make_plane(bake.bounce);
  bake.irradiance.resize(count("irradiance."));
  for (Grid<float>& plane : bake.irradiance) make_plane(plane);
  if (has("total")) make_plane(bake.total);
  if (has("residual")) make_plane(bake.residual);
  if (count("normal.") > 0) make_plane(bake.normals);
  if (count("bent.") > 0) make_plane(bake.bent_normals);
  if (planes_of<float>(bake).empty())
    throw InputError(fmt::format(
        "{}: holds none of the channels of a bake, expected a file of `hemibake bake`", path.string()));
  return bake;
}

double read_bounce_albedo(const fs::path& path, const Provenance& provenance) {
  const auto found = provenance.find("bounce_albedo");
  if (found != provenance.end() && found->is_number()) {
    const double albedo = found->get<double>();
    if (albedo > 0 && albedo < 1) return albedo;
  }
  throw InputError(
      fmt::format("{}: attribute hemibake:bounce_albedo is missing or outside 0..1, expected the albedo of "
                  "channel bounce",
                  path.string()));
}

struct Range {
  double low, high;
};

void check_plane(const fs::path& path, const std::string& channel, const Grid<float>& plane, Range range) {
  for (size_t i = 0; i < plane.size(); ++i) {
    const double value = static_cast<double>(plane[i]);
    if (std::isnan(value) || (value >= range.low && value <= range.high)) continue;
    const auto width = static_cast<size_t>(plane.width);
    throw InputError(fmt::format("{}: channel {} is {} at texel {},{}, expected {} to {:.7g}", path.string(),
                                 channel, plane[i], i % width, i / width, range.low == 0 ? 0 : range.low,
                                 range.high));
  }
}

// may_vanish: whether vectors of length 0 stand for no direction.
void check_vectors(const fs::path& path, const char* channel, const Grid<glm::vec3>& plane, bool may_vanish) {
  for (size_t i = 0; i < plane.size(); ++i) {
    const double length = glm::length(glm::dvec3(plane[i]));
    if (std::isnan(length) || std::abs(length - 1) <= kUnitLength || (may_vanish && length == 0)) continue;
    const auto width = static_cast<size_t>(plane.width);
    throw InputError(fmt::format("{}: channel {} has length {} at texel {},{}, expected 1", path.string(),
                                 channel, length, i % width, i / width));
  }
}

// Returns whether light may come out above 1: published weights, stored lengths of normals, and cones less
// than the hemisphere do not keep energy.
bool may_gain_light(const Provenance& provenance) {
  const auto says = [&](const char* name, const char* value) {
    const auto found = provenance.find(name);
    return found != provenance.end() && *found == value;
  };
  const auto cone = provenance.find("cone_degrees");
  return says("normalize", "published") || says("normal_length", "stored") ||
         (cone != provenance.end() && cone->is_number() && cone->get<double>() < 180);
}

// Refuses values out of their range; what is not a number is an open hole, or was refused before.
void check_ranges(const fs::path& path, const BakeFile& file) {
  const Bake& bake = file.bake;
  const double most = may_gain_light(file.provenance) ? kMostGainedLight : 1 + kRounding;
  const Range light{-kRounding, most}, irradiance{-kRounding * kPi, most * kPi};
  check_plane(path, "ao", bake.visible_fraction, {-kRounding, 1 + kRounding});
  check_plane(path, "visibility", bake.visibility, light);
  for (size_t b = 0; b < bake.irradiance.size(); ++b)
    check_plane(path, irradiance_channel(b), bake.irradiance[b], irradiance);
  check_plane(path, "total", bake.total, irradiance);
  check_plane(path, "residual", bake.residual, {-most, most});
  check_plane(path, "bounce", bake.bounce, light);
  check_vectors(path, "normal", bake.normals, false);
  check_vectors(path, "bent", bake.bent_normals, true);
}

bool is_tiff(const std::string& extension) { return extension == ".tif" || extension == ".tiff"; }

// Writes the planes as bands of a TIFF. Open holes are NoData.
void write_bands(OutputFile& file, const Bake& bake, const Provenance& provenance) {
  const std::vector<Plane> planes = planes_of<const float>(bake);
  const GeoPlace place = recorded_place(provenance).value_or(GeoPlace{});
  write_geo_tiff(file, bake.width, bake.height, planes, {place, holes_of(bake)}, provenance);
}

// Throws InputError where a texel has no value in one plane, but one in another.
void check_holes(const fs::path& path, Bake& bake) {
  for (const BasicPlane<float>& plane : planes_of<float>(bake))
    for (size_t i = 0; i < static_cast<size_t>(bake.width) * static_cast<size_t>(bake.height); ++i)
      if (std::isnan(plane.first[i * plane.stride]) && !is_hole(bake, i))
        throw InputError(fmt::format(
            "{}: channel {} is nan at texel {},{}, expected a number, or nan in all channels", path.string(),
            plane.channel, i % static_cast<size_t>(bake.width), i / static_cast<size_t>(bake.width)));
}

}  // namespace

void write_bake(OutputFile& file, const Bake& bake, const Provenance& provenance) {
  check_sizes(bake);
  const std::string extension = lower_case_extension(file.path());
  if (is_tiff(extension)) return write_bands(file, bake, provenance);
  if (extension != ".exr")
    throw InputError(fmt::format("{}: a bake cannot be written as '{}', expected .exr or .tif",
                                 file.path().string(), file.path().extension().string()));
  write_image(file, bake.width, bake.height, planes_of<const float>(bake), provenance);
}

void write_bake(const fs::path& path, const Bake& bake, const Provenance& provenance) {
  OutputFile file(path);
  write_bake(file, bake, provenance);
  file.commit();
}

BakeFile read_bake(const fs::path& path) {
  if (is_tiff(lower_case_extension(path)))
    throw InputError(
        fmt::format("{}: bakes are read from EXR, expected the .exr of `hemibake bake`", path.string()));
  const ImageHeader header = read_image_header(path);
  if (!header.provenance.is_object())
    throw InputError(
        fmt::format("{}: has no hemibake attributes, expected a file of `hemibake bake`", path.string()));
  BakeFile file{make_room(path, header), header.provenance};
  if (!file.bake.bounce.empty()) file.bake.bounce_albedo = read_bounce_albedo(path, header.provenance);
  const bool open = header.provenance.value("holes", "") == "open";
  read_planes(path, header.width, header.height, planes_of<float>(file.bake),
              open ? MissingValues::kNaN : MissingValues::kRefused);
  if (open) check_holes(path, file.bake);
  check_ranges(path, file);
  return file;
}

}  // namespace hemibake
