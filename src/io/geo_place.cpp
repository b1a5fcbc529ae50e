#include "io/geo_place.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "core/error.h"
#include "core/printable.h"
#include "io/byte_reader.h"
#include "io/output_file.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

constexpr std::array kExtensions = {".hgt", ".asc", ".bil", ".bip", ".bsq", ".vrt", ".nc",  ".dem",
                                    ".img", ".flt", ".adf", ".dt0", ".dt1", ".dt2", ".grd", ".sdat",
                                    ".xyz", ".bt",  ".rst", ".ddf", ".ter", ".map"};

constexpr std::array kWithHeader = {".bil", ".bip", ".bsq", ".flt", ".img", ".dem"};

// ModelPixelScale, ModelTiepoint, ModelTransformation, GeoKeyDirectory.
constexpr std::array<uint64_t, 4> kGeoTags = {33550, 33922, 34264, 34735};
constexpr uint64_t kMostTags = 4096;

// Reads the first directory of tags: TIFF 6.0, and BigTIFF with its wider numbers.
bool has_geo_tags(const fs::path& path) {
  ByteReader file(path);
  const uint64_t mark = file.at(0, 2);
  if (mark != 0x4949 && mark != 0x4D4D) return false;
  if (mark == 0x4D4D) file.order = std::endian::big;
  const uint64_t version = file.at(2, 2);
  if (version != 42 && version != 43) return false;
  const bool big = version == 43;
  const uint64_t directory = big ? file.at(8, 8) : file.at(4, 4);
  const uint64_t count = std::min(kMostTags, file.at(directory, big ? 8 : 2));
  for (uint64_t i = 0; i < count; ++i) {
    const uint64_t tag = file.at(directory + (big ? 8 + 20 * i : 2 + 12 * i), 2);
    if (std::ranges::find(kGeoTags, tag) != kGeoTags.end()) return true;
  }
  return false;
}

double number_in(std::string_view text, const char* name) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size())
    throw InputError(fmt::format("attribute hemibake:{}: '{}', expected a number", name, excerpt(text)));
  return value;
}

std::array<double, 6> transform_in(std::string_view text) {
  std::array<double, 6> transform{};
  for (size_t i = 0; i < transform.size(); ++i) {
    const size_t comma = i + 1 < transform.size() ? text.find(',') : text.size();
    if (comma == std::string_view::npos)
      throw InputError("attribute hemibake:geo_transform: expected six numbers between commas");
    transform[i] = number_in(text.substr(0, comma), "geo_transform");
    if (!std::isfinite(transform[i]))
      throw InputError("attribute hemibake:geo_transform: expected six finite numbers");
    text.remove_prefix(std::min(text.size(), comma + 1));
  }
  return transform;
}

}  // namespace

bool is_geo_file(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error) || fs::file_size(path, error) == 0 || error) return false;
  const std::string extension = lower_case_extension(path);
  if (extension == ".tif" || extension == ".tiff") return has_geo_tags(path);
  return std::ranges::find(kExtensions, extension) != kExtensions.end();
}

bool is_geo_header(const fs::path& path) {
  if (lower_case_extension(path) != ".hdr") return false;
  return std::ranges::any_of(kWithHeader, [&](const char* extension) {
    std::error_code not_there;
    return fs::is_regular_file(fs::path(path).replace_extension(extension), not_there);
  });
}

void record_place(const GeoPlace& place, Provenance& provenance) {
  provenance["geo_crs"] = valid_utf8(place.crs);
  provenance["geo_transform"] = fmt::format("{}", fmt::join(place.transform, ","));
  if (place.no_data) provenance["geo_nodata"] = fmt::format("{}", *place.no_data);
}

std::optional<GeoPlace> recorded_place(const Provenance& provenance) {
  const auto text = [&](const char* key) -> std::optional<std::string> {
    if (!provenance.is_object() || !provenance.contains(key) || !provenance[key].is_string()) return {};
    return provenance[key].get<std::string>();
  };
  const std::optional<std::string> transform = text("geo_transform");
  if (!transform) return std::nullopt;
  GeoPlace place;
  place.crs = text("geo_crs").value_or("");
  place.transform = transform_in(*transform);
  if (const auto no_data = text("geo_nodata")) place.no_data = number_in(*no_data, "geo_nodata");
  return place;
}

GeoPlace place_without_ring(GeoPlace place, int texels) {
  auto& t = place.transform;
  t[0] += texels * (t[1] + t[2]);
  t[3] += texels * (t[4] + t[5]);
  return place;
}

}  // namespace hemibake
