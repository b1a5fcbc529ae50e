#include "cli/batch.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>

#include "bake/bake.h"
#include "bake/record.h"
#include "cli/print/streams.h"
#include "core/error.h"
#include "io/geo_place.h"
#include "io/image_io.h"
#include "io/output_file.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

constexpr std::array kImageExtensions = {".png", ".tif", ".tiff", ".exr",  ".hdr",
                                         ".bmp", ".tga", ".jpg",  ".jpeg", ".pgm"};

bool is_folder(const fs::path& path) {
  std::error_code not_there;
  return fs::is_directory(path, not_there);
}

enum class ImageKind { kMap, kBake, kTexture };

// Returns what an image is; textures lie beside maps and bakes.
ImageKind kind_of(const fs::path& path) {
  try {
    const Provenance made = read_image_header(path).provenance;
    if (!made.is_object() || !made.contains("tracer")) return ImageKind::kMap;
    return made.contains("texture") ? ImageKind::kTexture : ImageKind::kBake;
  } catch (const InputError&) {
    return ImageKind::kMap;  // is named as a bad map
  }
}

// Returns the images of a folder that are no results, by name; the bakes where there are no others.
std::vector<fs::path> images_in(const fs::path& folder) {
  std::vector<fs::path> images, bakes;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const fs::path& path = entry->path();
    std::error_code not_there;
    const bool is_image =
        entry->is_regular_file(not_there) && path.filename().string()[0] != '.' && !is_geo_header(path) &&
        (is_geo_file(path) ||
         std::ranges::find(kImageExtensions, lower_case_extension(path)) != kImageExtensions.end());
    if (!is_image) continue;
    const ImageKind kind = kind_of(path);
    if (kind == ImageKind::kMap) images.push_back(path);
    if (kind == ImageKind::kBake) bakes.push_back(path);
  }
  if (error)
    throw InputError(fmt::format("{}: could not read the folder: {}", folder.string(), error.message()));
  if (images.empty()) images = std::move(bakes);
  std::ranges::sort(images);
  if (images.empty())
    throw InputError(folder.string() + ": a folder without images, expected height maps in it");
  return images;
}

}  // namespace

void take_several_maps(std::vector<Field>& fields, std::vector<std::string>& maps) {
  const auto field = std::ranges::find(fields, "MAP", &Field::name);
  field->value = texts(maps);
  field->help =
      "height map: PNG, TIFF, EXR or anything else OpenImageIO reads, or terrain (GeoTIFF, VRT, ...) in "
      "metres; "
      "several, or a folder of them: each is done, bad ones are named, done ones skipped";
}

MapOutcome skipped(const fs::path& map, const fs::path& output) {
  return {{{"input", map.filename().string()}, {"output", output.string()}, {"skipped", true}},
          "",
          fmt::format("{}: done before: {}", map.string(), output.string()),
          0};
}

bool names_many(const std::vector<std::string>& arguments) {
  return arguments.size() > 1 || is_folder(arguments[0]);
}

std::vector<fs::path> find_maps(const std::vector<std::string>& arguments) {
  std::vector<fs::path> maps;
  for (const fs::path argument : arguments) {
    if (!is_folder(argument))
      maps.push_back(argument);
    else
      std::ranges::copy(images_in(argument), std::back_inserter(maps));
  }
  std::map<std::string, fs::path> by_name;
  for (const fs::path& path : maps) {
    const auto [known, is_new] = by_name.emplace(path.stem().string(), path);
    if (!is_new)
      throw InputError(fmt::format("{}: has the name of {}, expected maps of different names", path.string(),
                                   known->second.string()));
  }
  return maps;
}

void refuse_settings_of_one_map(const Invocation& invocation, std::initializer_list<const char*> names) {
  for (const char* name : names)
    if (invocation.given(name))
      throw InputError(fmt::format("--{}: is of one map, expected one map with it", name));
}

Provenance wanted_record(const LoadedMap& map, const BakeSettings& settings) {
  Provenance wanted = make_provenance("");
  record_map(map.settings, map.sha256, wanted);
  BakeSettings copy = settings;
  resolve_for_holes(map.surface, copy);
  record_fields(bake_fields(copy), wanted);
  for (const char* elsewhere : {"command", "input_path", "normals_path"}) wanted.erase(elsewhere);
  if (settings.target_error)
    for (const char* chosen : {"rays", "bounces"}) wanted.erase(chosen);
  return wanted;
}

MapNeed need_of_bake(const BakeOptions& options, Again again, const fs::path& made) {
  std::error_code not_there;
  if (again == Again::kSkip && fs::is_regular_file(made, not_there)) return {};
  return [&options](int width, int height) {
    return least_bake_bytes(width, height, options.map, options.bake);
  };
}

bool records(const fs::path& image, const Provenance& wanted) {
  std::error_code not_there;
  if (!fs::is_regular_file(image, not_there)) return false;
  Provenance made;
  try {
    made = read_image_header(image).provenance;
  } catch (const InputError&) {
    return false;
  }
  if (!made.is_object()) return false;
  return std::ranges::all_of(wanted.items(), [&](const auto& item) {
    const auto found = made.find(item.key());
    return found != made.end() && *found == item.value();
  });
}

int run_over_maps(const std::vector<fs::path>& maps, const Invocation& invocation,
                  const std::function<MapOutcome(const fs::path& map)>& run_one) {
  nlohmann::ordered_json done = nlohmann::ordered_json::array();
  std::vector<std::string> bad;
  int exit_code = 0;
  const auto name_bad = [&](const fs::path& map, const std::string& message) {
    print_message(message);
    bad.push_back(map.string());
  };
  for (size_t i = 0; i < maps.size(); ++i) {
    try {
      MapOutcome outcome = run_one(maps[i]);
      exit_code = std::max(exit_code, outcome.exit_code);
      if (!invocation.json)
        invocation.print({}, fmt::format("[{}/{}] {}\n", i + 1, maps.size(), outcome.line));
      done.push_back(std::move(outcome.json));
    } catch (const SettingError& error) {
      name_bad(maps[i], error.with_prefix("--"));
    } catch (const InputError& error) {
      name_bad(maps[i], error.what());
    }
  }
  if (!bad.empty())
    print_message(fmt::format("{} of {} maps were bad: {}", bad.size(), maps.size(), fmt::join(bad, ", ")));
  if (invocation.json) invocation.print({{"maps", done}, {"bad", bad}}, "");
  return bad.empty() ? exit_code : 2;
}

}  // namespace hemibake
