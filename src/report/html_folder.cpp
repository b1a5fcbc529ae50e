#include "report/html_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "core/error.h"
#include "io/curves_file.h"
#include "io/output_file.h"
#include "io/table_io.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

constexpr int kDefaultBins = 100;

// Null where the file is not there. list: what it has to have, none if empty.
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

}  // namespace

ReportFolder read_report_folder(const fs::path& path) {
  if (!fs::is_directory(path))
    throw InputError(
        fmt::format("{}: is not a folder, expected one that 'hemibake run' wrote", path.string()));
  ReportFolder folder;
  folder.path = path;
  if (fs::exists(path / "bake.exr")) folder.bake = read_bake(path / "bake.exr");
  if (fs::exists(path / "curves.csv")) folder.curves = read_curves(path / "curves.csv");
  if (fs::exists(path / "fit.json")) folder.fits = read_fits(path / "fit.json");
  folder.check = read_if_there(path / "check.json", "checks");
  folder.run = read_if_there(path / "run.json", "");
  folder.trade = read_if_there(path / "trade.json", "runs");
  read_sweep(path, folder.sweep);
  read_sweep(path / "sweep", folder.sweep);
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
