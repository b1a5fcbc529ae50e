#include "report/html_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "core/error.h"
#include "io/curves_file.h"
#include "io/input_file.h"
#include "io/output_file.h"
#include "io/provenance.h"
#include "io/table_io.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

constexpr int kDefaultBins = 100;

// Returns null where the file is not there. list: name of a list that it must have, or empty.
nlohmann::ordered_json read_if_there(const fs::path& path, const char* list) {
  if (!fs::exists(path)) return nullptr;
  nlohmann::ordered_json json = read_json(path);
  if (!json.is_object()) throw InputError(path.string() + ": is not an object of JSON, expected one");
  if (*list != '\0' && (!json.contains(list) || !json[list].is_array()))
    throw InputError(fmt::format("{}: has no list \"{}\", expected one", path.string(), list));
  return json;
}

std::optional<double> amplitude_of(const fs::path& path) {
  if (lower_case_extension(path) != ".csv") return std::nullopt;
  const std::string stem = path.stem().string();
  double amplitude = 0;
  const auto [end, error] = std::from_chars(stem.data(), stem.data() + stem.size(), amplitude);
  if (error != std::errc() || end != stem.data() + stem.size() || !(amplitude > 0)) return std::nullopt;
  return amplitude;
}

void read_sweep(const fs::path& folder, std::vector<SweepCurves>& sweep) {
  if (!fs::is_directory(folder)) return;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (const auto amplitude = amplitude_of(entry.path()); amplitude && entry.is_regular_file())
      sweep.push_back({*amplitude, read_curves(entry.path())});
}

// Bytes of pictures on a page: with the 8 MiB of a 512 x 512 bake, and a third more as text, it stays below
// 12 MiB.
constexpr size_t kPictureBytes = 3000000;

// Figures, which have no EXR of their own and show several pictures side by side, come first.
void read_pictures(const fs::path& folder, std::vector<ReportPicture>& pictures) {
  const nlohmann::ordered_json record = read_if_there(folder / "render.json", "pictures");
  if (record.is_null()) return;
  size_t room = kPictureBytes;
  for (const bool figures : {true, false})
    for (const nlohmann::ordered_json& entry : record["pictures"]) {
      if (!entry.is_object() || !entry.contains("files") || !entry["files"].is_array()) continue;
      if ((entry["files"].size() == 1) != figures) continue;
      for (const nlohmann::ordered_json& name : entry["files"]) {
        if (!name.is_string()) continue;
        // A name, wherever the list came from: never a way out of the folder.
        const fs::path file = folder / fs::path(name.get<std::string>()).filename();
        if (lower_case_extension(file) != ".png" || !fs::is_regular_file(file)) continue;
        std::string png = fs::file_size(file) <= room ? read_whole_file(file) : std::string();
        room -= png.size();
        pictures.push_back({valid_utf8(file.stem().string()), std::move(png)});
      }
    }
}

}  // namespace

ReportFolder read_report_folder(const fs::path& path) {
  if (!fs::is_directory(path))
    throw InputError(
        fmt::format("{}: is not a folder, expected one that 'hemibake run' wrote", path.string()));
  ReportFolder folder;
  folder.path = path;
  if (fs::exists(path / "bake.exr")) folder.bake = read_bake(path / "bake.exr");
  if (fs::exists(path / "curves.csv")) folder.curves = read_curves(path / "curves.csv");
  if (folder.curves && folder.curves->index != CurveIndex::kAo)
    throw InputError(
        fmt::format("{}: curves over visibility, expected curves over ao", (path / "curves.csv").string()));
  if (fs::exists(path / "fit.json")) folder.fits = read_fits(path / "fit.json");
  folder.check = read_if_there(path / "check.json", "checks");
  folder.run = read_if_there(path / "run.json", "");
  folder.trade = read_if_there(path / "trade.json", "runs");
  read_sweep(path, folder.sweep);
  read_sweep(path / "sweep", folder.sweep);
  read_pictures(path, folder.pictures);
  read_pictures(path / "pictures", folder.pictures);
  std::ranges::sort(folder.sweep, {}, &SweepCurves::amplitude_m);
  if (!folder.bake && !folder.curves && !folder.fits && folder.check.is_null() && folder.trade.is_null() &&
      folder.sweep.empty())
    throw InputError(fmt::format(
        "{}: has none of bake.exr, curves.csv, fit.json, check.json and trade.json, expected a folder that "
        "'hemibake run' wrote",
        path.string()));
  if (folder.bake && !folder.curves && !folder.bake->bake.visible_fraction.empty() &&
      !folder.bake->bake.irradiance.empty())
    folder.curves = make_curves(folder.bake->bake, kDefaultBins);
  return folder;
}

}  // namespace hemibake
