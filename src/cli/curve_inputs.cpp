#include "cli/curve_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>

#include "core/context.h"
#include "core/error.h"
#include "io/bake_file.h"
#include "io/curves_file.h"
#include "io/file_context.h"
#include "io/output_file.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

constexpr int kBins = 100;
// The names of one map's results, the one that is read first.
constexpr const char* kResults[] = {"curves.csv", "bake.exr"};

std::string name_of_map(const fs::path& path) {
  const bool is_result = std::ranges::find(kResults, path.filename().string()) != std::end(kResults);
  std::error_code error;
  return is_result ? fs::absolute(path, error).lexically_normal().parent_path().filename().string()
                   : path.stem().string();
}

Curves curves_of_file(const fs::path& path) {
  if (lower_case_extension(path) != ".exr") return read_curves(path);
  const Bake bake = read_bake(path).bake;
  return with_file_context(path, [&] { return make_curves(bake, kBins); });
}

// Returns curves.csv or bake.exr of one map's folder.
std::optional<fs::path> result_in(const fs::path& folder) {
  for (const char* name : kResults)
    if (std::error_code not_there; fs::is_regular_file(folder / name, not_there)) return folder / name;
  return std::nullopt;
}

bool is_folder(const fs::path& path) {
  std::error_code not_there;
  return fs::is_directory(path, not_there);
}

bool begins_like_curves(const fs::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line.starts_with("bin,");
}

// Returns the files of a folder that may be maps, by name; curves before the bake they were made of.
std::vector<fs::path> files_in(const fs::path& folder, std::vector<std::string>& skipped) {
  if (const auto result = result_in(folder)) return {*result};
  std::vector<fs::path> entries, files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    entries.push_back(entry->path());
  if (error)
    throw InputError(fmt::format("{}: could not read the folder: {}", folder.string(), error.message()));
  std::ranges::sort(entries);
  for (const fs::path& entry : entries) {
    const std::string extension = lower_case_extension(entry);
    const fs::path curves = fs::path(entry).replace_extension(".csv");
    if (is_folder(entry)) {
      if (const auto result = result_in(entry)) files.push_back(*result);
    } else if (extension == ".csv") {
      if (begins_like_curves(entry))
        files.push_back(entry);
      else
        skipped.push_back(entry.string() + ": skipped: no curves");
    } else if (extension == ".exr" && !fs::exists(curves, error)) {
      files.push_back(entry);
    }
  }
  return files;
}

std::vector<CurveInput> read_folder(const fs::path& folder, std::vector<std::string>& skipped) {
  std::vector<CurveInput> inputs;
  for (const fs::path& file : files_in(folder, skipped)) {
    throw_if_cancelled();
    try {
      inputs.push_back({file.string(), {name_of_map(file), curves_of_file(file)}});
    } catch (const InputError& error) {
      // Any image may lie in a folder; what begins like curves must be whole.
      if (lower_case_extension(file) != ".exr") throw;
      skipped.push_back(fmt::format("{}: skipped: no bake with ao and irradiance", file.string()));
    }
  }
  if (inputs.empty())
    throw InputError(
        fmt::format("{}: no maps in this folder, expected */curves.csv, */bake.exr, curves as CSV or "
                    "bakes as EXR; make them with 'hemibake run' or 'hemibake bake'",
                    folder.string()));
  return inputs;
}

void expect_different_names(const std::vector<CurveInput>& inputs) {
  std::map<std::string, std::string> path_of;
  for (const CurveInput& input : inputs) {
    const auto [known, is_new] = path_of.emplace(input.map.name, input.path);
    if (!is_new && known->second != input.path)
      throw InputError(fmt::format("{}, {}: two maps of the name '{}', expected a name each; rename one",
                                   known->second, input.path, input.map.name));
  }
}

}  // namespace

std::vector<CurveInput> read_curve_inputs(const std::vector<std::string>& arguments,
                                          std::vector<std::string>& skipped) {
  std::vector<CurveInput> inputs;
  for (const std::string& argument : arguments) {
    if (is_folder(argument)) {
      std::vector<CurveInput> found = read_folder(argument, skipped);
      std::ranges::move(found, std::back_inserter(inputs));
    } else {
      inputs.push_back({argument, {name_of_map(argument), curves_of_file(argument)}});
    }
  }
  expect_different_names(inputs);
  return inputs;
}

std::vector<MapCurves> maps_of(const std::vector<CurveInput>& inputs) {
  std::vector<MapCurves> maps;
  for (const CurveInput& input : inputs) maps.push_back(input.map);
  return maps;
}

}  // namespace hemibake
