#include "fuzz/targets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/options/parser.h"
#include "core/error.h"
#include "io/bake_file.h"
#include "io/curves_file.h"
#include "io/fit_file.h"
#include "io/height_file.h"
#include "io/image_io.h"
#include "io/io_testing.h"
#include "io/links_file.h"
#include "io/table_io.h"
#include "io/tiff_pages.h"
#include "report/html_data.h"
#include "report/html_folder.h"
#include "report/html_json.h"
#include "report/html_planes.h"
#include "surface/normals.h"
#include "transport/links/form_factors.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

// What a map or an image may hold here: far more than the corpus, little enough for thousands of runs a
// minute.
constexpr int kMostPixels = 1 << 22;

// Returns a file of that name that holds `bytes`, in a folder that lives as long as the process.
fs::path file_of(const char* name, std::string_view bytes) {
  static const TemporaryFolder folder;
  const fs::path path = folder / name;
  std::ofstream(path, std::ios::binary | std::ios::trunc)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return path;
}

// Returns whether the header is readable and claims an image that is worth reading.
bool is_small(const fs::path& path) {
  const ImageHeader header = read_image_header(path);
  return static_cast<int64_t>(header.width) * header.height <= kMostPixels;
}

// Aborts where a reader lets through what no later step expects: then the file should have been refused.
void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "a reader returned %s\n", what);
  std::abort();
}

void require_finite(const Grid<glm::vec3>& grid) {
  for (const glm::vec3& value : grid.values)
    require(std::isfinite(value.x) && std::isfinite(value.y) && std::isfinite(value.z), "no number");
}

// Requires one length for the rows and finite values of every plane, but for holes.
void require_heights(const HeightFile& file) {
  const size_t texels = static_cast<size_t>(file.values.width) * static_cast<size_t>(file.values.height);
  require(texels > 0 && file.values.size() == texels, "heights of another size");
  require(file.holes.empty() || file.holes.size() == texels, "holes of another size");
  for (const float height : file.values.values) require(std::isfinite(height), "a height that is no number");
  require(std::isfinite(file.full_scale) && file.full_scale > 0, "a scale of no use");
  require(std::isfinite(file.pixel_aspect) && file.pixel_aspect > 0, "an aspect of no use");
}

void require_plane(const Bake& bake, const Grid<float>& plane, float least, float most) {
  require(plane.empty() || (plane.width == bake.width && plane.height == bake.height),
          "a plane of another size");
  for (size_t i = 0; i < plane.size(); ++i)
    require((plane[i] >= least && plane[i] <= most) || is_hole(bake, i), "a plane out of its range");
}

void require_links(const FormFactorMatrix& matrix) {
  for (const FormFactorBlock& block : matrix.blocks) {
    BlockRows rows;
    unpack_block(block, rows);
    for (const uint32_t column : rows.columns) require(column < matrix.columns, "a link to nowhere");
    for (const float weight : rows.weights) require(weight >= 0 && weight < 2, "a weight out of its range");
  }
}

void require_bake(const Bake& bake) {
  constexpr float kInf = std::numeric_limits<float>::max();
  require_plane(bake, bake.visible_fraction, -.01f, 1.01f);
  for (const Grid<float>* plane : {&bake.visibility, &bake.total, &bake.residual, &bake.bounce})
    require_plane(bake, *plane, -kInf, kInf);
  for (const Grid<float>& plane : bake.irradiance) require_plane(bake, plane, -.01f, kInf);
  for (size_t i = 0; i < bake.normals.size(); ++i)
    require(std::abs(glm::length(glm::dvec3(bake.normals[i])) - 1) < .01 || is_hole(bake, i),
            "a normal whose length is not 1");
}

void read_heights(std::string_view bytes) {
  const fs::path path = file_of("heights.png", bytes);
  if (is_small(path)) require_heights(read_height_file(path, {}));
}

void read_normals(std::string_view bytes) {
  const fs::path path = file_of("normals.png", bytes);
  const ImageHeader header = read_image_header(path);
  if (!is_small(path)) return;
  const NormalImage image = read_normal_map(path, header.width, header.height);
  require_finite(image.values);
  const NormalDecoding decoding{image.stored_as_integers ? NormalEncoding::kLinear : NormalEncoding::kSigned};
  for (const glm::vec3& normal : decode_normal_map(image.values, decoding).values)
    require(std::abs(glm::length(glm::dvec3(normal)) - 1) < 1e-5, "a normal whose length is not 1");
}

void read_color(std::string_view bytes) {
  const fs::path path = file_of("color.png", bytes);
  if (is_small(path)) require_finite(read_color_image(path).colors);
}

void read_tiff(std::string_view bytes) {
  const fs::path path = file_of("pages.tif", bytes);
  tiff_pages(path);
  webp_orientation(path);
}

// Reads a raster of names of its own: the first line holds the names of its files, the raster first, then
// come the files, each but the last with a line of dashes after it.
void read_terrain(std::string_view bytes) {
  constexpr std::string_view kBetween = "\n-----\n";
  const size_t end = std::min(bytes.find('\n'), bytes.size());
  std::istringstream names(std::string(bytes.substr(0, end)));
  bytes.remove_prefix(std::min(end + 1, bytes.size()));
  fs::path raster;
  for (std::string name; names >> name;) {
    const std::string extension = fs::path(name).extension().string();
    if (extension.size() > 8 || extension.find('\0') != std::string::npos) return;
    const size_t length = std::min(bytes.find(kBetween), bytes.size());
    const fs::path path = file_of(("terrain" + extension).c_str(), bytes.substr(0, length));
    if (raster.empty()) raster = path;
    bytes.remove_prefix(std::min(length + kBetween.size(), bytes.size()));
  }
  if (!raster.empty()) require_heights(read_height_file(raster, {}));
}

void read_pnm(std::string_view bytes) {
  require_heights(read_height_file(file_of("heights.pgm", bytes), {}));
}

void read_npy(std::string_view bytes) {
  require_heights(read_height_file(file_of("heights.npy", bytes), {}));
}

// The first line is the layout, the rest the file.
void read_raw(std::string_view bytes) {
  const size_t end = std::min(bytes.find('\n'), bytes.size());
  HeightFileOptions options;
  options.raw = std::string(bytes.substr(0, end));
  if (options.raw.empty()) options.raw = "1x1:u8";
  require_heights(
      read_height_file(file_of("heights.raw", bytes.substr(std::min(end + 1, bytes.size()))), options));
}

void read_bake_bytes(std::string_view bytes) {
  const fs::path path = file_of("bake.exr", bytes);
  if (is_small(path)) require_bake(read_bake(path).bake);
}

void read_fit_bytes(std::string_view bytes) { read_fits(file_of("fit.json", bytes)); }

void read_curves_bytes(std::string_view bytes) { read_curves(file_of("curves.csv", bytes)); }

void read_links_bytes(std::string_view bytes) {
  const LinksFile file = read_links(file_of("links.h5", bytes));
  require_links(file.final_gather);
  if (file.patch_form_factors) require_links(*file.patch_form_factors);
  for (const float light : file.direct) require(std::isfinite(light), "light that is no number");
}

// A table of camera and sky numbers is free text too.
void read_number_list(std::string_view bytes) { read_numbers(file_of("numbers.txt", bytes), 6); }

// Makes what a report shows of a folder that holds this one file.
void read_report(const char* name, std::string_view bytes) {
  const fs::path folder = file_of("report", "").parent_path() / (std::string("report-of-") + name);
  fs::create_directories(folder);
  std::ofstream(folder / name, std::ios::binary | std::ios::trunc)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  const ReportFolder report = read_report_folder(folder);
  const Bake bake;
  const PackedPlanes planes = pack_planes(bake, 64);
  const std::vector<ReportModel> models = report_models(report.fits, nullptr);
  const Rgb albedo = {0.9, 0.6, 0.2};
  json_from_report(report, models, planes, gather_report(report, models, albedo));
}

void read_check(std::string_view bytes) { read_report("check.json", bytes); }

void read_trade(std::string_view bytes) { read_report("trade.json", bytes); }

// One word per line, after the program's name. Parses, and does not run.
void read_options(std::string_view bytes) {
  std::vector<std::string> words = {"hemibake"};
  for (size_t begin = 0; begin <= bytes.size();) {
    const size_t end = std::min(bytes.find('\n', begin), bytes.size());
    std::string word(bytes.substr(begin, end - begin));
    word.erase(std::find(word.begin(), word.end(), '\0'), word.end());
    if (!word.empty()) words.push_back(std::move(word));
    begin = end + 1;
  }
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  const int count = static_cast<int>(arguments.size());
  arguments.push_back(nullptr);
  parse_command_line(count, arguments.data(), commands());
}

constexpr std::array kTargets = {
    FuzzTarget{"bake", read_bake_bytes},   FuzzTarget{"check", read_check},
    FuzzTarget{"color", read_color},       FuzzTarget{"curves", read_curves_bytes},
    FuzzTarget{"fit", read_fit_bytes},     FuzzTarget{"heights", read_heights},
    FuzzTarget{"links", read_links_bytes}, FuzzTarget{"normals", read_normals},
    FuzzTarget{"npy", read_npy},           FuzzTarget{"numbers", read_number_list},
    FuzzTarget{"options", read_options},   FuzzTarget{"pnm", read_pnm},
    FuzzTarget{"raw", read_raw},           FuzzTarget{"terrain", read_terrain},
    FuzzTarget{"tiff", read_tiff},         FuzzTarget{"trade", read_trade}};

}  // namespace

std::span<const FuzzTarget> fuzz_targets() { return kTargets; }

const FuzzTarget* find_fuzz_target(std::string_view name) {
  const auto found = std::find_if(kTargets.begin(), kTargets.end(),
                                  [&](const FuzzTarget& target) { return name == target.name; });
  return found == kTargets.end() ? nullptr : &*found;
}

void run_fuzz_target(const FuzzTarget& target, std::string_view bytes) {
  try {
    target.read(bytes);
    return;
  } catch (const InputError& error) {
    if (std::string_view(error.what()).find('\n') == std::string_view::npos) return;
    std::fprintf(stderr, "%s: an error of several lines: %s\n", target.name, error.what());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: no InputError: %s\n", target.name, error.what());
  }
  std::abort();
}

}  // namespace hemibake
