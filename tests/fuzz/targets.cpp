#include "fuzz/targets.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
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

void read_heights(std::string_view bytes) {
  const fs::path path = file_of("heights.png", bytes);
  if (is_small(path)) read_height_file(path, {});
}

void read_normals(std::string_view bytes) {
  const fs::path path = file_of("normals.png", bytes);
  const ImageHeader header = read_image_header(path);
  if (is_small(path)) read_normal_map(path, header.width, header.height);
}

void read_color(std::string_view bytes) {
  const fs::path path = file_of("color.png", bytes);
  if (is_small(path)) read_color_image(path);
}

void read_tiff(std::string_view bytes) {
  const fs::path path = file_of("pages.tif", bytes);
  tiff_pages(path);
  webp_orientation(path);
}

void read_terrain(std::string_view bytes) { read_height_file(file_of("terrain.asc", bytes), {}); }

void read_pnm(std::string_view bytes) { read_height_file(file_of("heights.pgm", bytes), {}); }

void read_npy(std::string_view bytes) { read_height_file(file_of("heights.npy", bytes), {}); }

// The first line is the layout, the rest the file.
void read_raw(std::string_view bytes) {
  const size_t end = std::min(bytes.find('\n'), bytes.size());
  HeightFileOptions options;
  options.raw = std::string(bytes.substr(0, end));
  if (options.raw.empty()) options.raw = "1x1:u8";
  read_height_file(file_of("heights.raw", bytes.substr(std::min(end + 1, bytes.size()))), options);
}

void read_bake_bytes(std::string_view bytes) {
  const fs::path path = file_of("bake.exr", bytes);
  if (is_small(path)) read_bake(path);
}

void read_fit_bytes(std::string_view bytes) { read_fits(file_of("fit.json", bytes)); }

void read_curves_bytes(std::string_view bytes) { read_curves(file_of("curves.csv", bytes)); }

void read_links_bytes(std::string_view bytes) { read_links(file_of("links.h5", bytes)); }

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
