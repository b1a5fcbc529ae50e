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
#include "report/html_records.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

constexpr int kDefaultBins = 100;

bool is_there(const fs::path& path) {
  std::error_code not_there;
  return fs::exists(path, not_there);
}

// Returns whether a file is there and, links followed, in the folder; says so where it leads out of it.
bool stays_in(const fs::path& file, ReportFolder& folder) {
  std::error_code not_there;
  const fs::path target = fs::canonical(file, not_there);
  if (not_there) return false;
  const fs::path root = fs::canonical(folder.path, not_there);
  if (std::ranges::mismatch(root, target).in1 == root.end()) return true;
  folder.warnings.push_back(file.string() + ": is left out: it is a link that leads out of the folder");
  return false;
}

// Returns null where the file is not there. list: name of a list that it must have, or empty; check: of it.
nlohmann::ordered_json read_if_there(const fs::path& path, const char* list,
                                     void (*check)(const JsonReader& json), ReportFolder& folder) {
  if (!is_there(path) || !stays_in(path, folder)) return nullptr;
  nlohmann::ordered_json json = read_json(path);
  if (!json.is_object()) throw InputError(path.string() + ": is not an object of JSON, expected one");
  if (*list != '\0' && (!json.contains(list) || !json[list].is_array()))
    throw InputError(fmt::format("{}: has no list \"{}\", expected one", path.string(), list));
  check(JsonReader(json, path.string()));
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

void read_sweep(const fs::path& path, ReportFolder& folder) {
  std::error_code error, not_there;
  if (!fs::is_directory(path, not_there)) return;
  for (fs::directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error)) {
    const auto amplitude = amplitude_of(entry->path());
    if (amplitude && fs::is_regular_file(entry->path(), not_there) && stays_in(entry->path(), folder))
      folder.sweep.push_back({*amplitude, read_curves(entry->path())});
  }
  if (error)
    throw InputError(fmt::format("{}: could not read the folder: {}", path.string(), error.message()));
}

// Bytes of pictures on a page: with the 8 MiB of a 512 x 512 bake, and a third more as text, it stays below
// 12 MiB.
constexpr size_t kPictureBytes = 3000000;

// Figures, which have no EXR of their own and show several pictures side by side, come first.
void read_pictures(const fs::path& path, ReportFolder& folder) {
  const nlohmann::ordered_json record =
      read_if_there(path / "render.json", "pictures", check_pictures_record, folder);
  if (record.is_null()) return;
  size_t room = kPictureBytes;
  for (const bool figures : {true, false})
    for (const nlohmann::ordered_json& entry : record["pictures"]) {
      if ((entry["files"].size() == 1) != figures) continue;
      for (const nlohmann::ordered_json& name : entry["files"]) {
        // A name, wherever the list came from: never a way out of the folder.
        const fs::path file = path / fs::path(name.get<std::string>()).filename();
        std::error_code unknown;
        if (lower_case_extension(file) != ".png" || !stays_in(file, folder) ||
            !fs::is_regular_file(file, unknown))
          continue;
        const bool fits = fs::file_size(file, unknown) <= room && !unknown;
        std::string png = fits ? read_whole_file(file) : std::string();
        room -= png.size();
        folder.pictures.push_back({valid_utf8(file.stem().string()), std::move(png)});
      }
    }
}

}  // namespace

ReportFolder read_report_folder(const fs::path& path) {
  std::error_code not_there;
  if (!fs::is_directory(path, not_there))
    throw InputError(
        fmt::format("{}: is not a folder, expected one that 'hemibake run' wrote", path.string()));
  ReportFolder folder;
  folder.path = path;
  if (is_there(path / "bake.exr")) folder.bake = read_bake(path / "bake.exr");
  if (is_there(path / "curves.csv")) folder.curves = read_curves(path / "curves.csv");
  if (folder.curves && folder.curves->index != CurveIndex::kAo)
    throw InputError(
        fmt::format("{}: curves over visibility, expected curves over ao", (path / "curves.csv").string()));
  if (is_there(path / "fit.json")) folder.fits = read_fits(path / "fit.json");
  folder.check = read_if_there(path / "check.json", "checks", check_checks_record, folder);
  folder.run = read_if_there(path / "run.json", "", check_run_record, folder);
  folder.trade = read_if_there(path / "trade.json", "runs", check_trade_record, folder);
  read_sweep(path, folder);
  read_sweep(path / "sweep", folder);
  read_pictures(path, folder);
  read_pictures(path / "pictures", folder);
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
