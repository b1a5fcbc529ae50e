// Reads the files of a folder that a report shows.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "curves/curves.h"
#include "io/bake_file.h"
#include "io/fit_file.h"

namespace hemibake {

// Holds the curves of one amplitude, from `scripts/sweep`.
struct SweepCurves {
  double amplitude_m = 0;
  Curves curves;
};

// Holds a PNG that `hemibake render` wrote, by its name in render.json.
struct ReportPicture {
  std::string name;
  std::string png;  // the file's bytes; empty where the page has no room for it
};

struct ReportFolder {
  std::filesystem::path path;
  std::optional<BakeFile> bake;    // bake.exr
  std::optional<Curves> curves;    // curves.csv, or made from the bake where that is not there
  std::optional<FitFile> fits;     // fit.json
  nlohmann::ordered_json check;    // check.json; null where it is not there
  nlohmann::ordered_json run;      // run.json: what `hemibake run --json` printed; or null
  nlohmann::ordered_json trade;    // trade.json; or null
  std::vector<SweepCurves> sweep;  // AMPLITUDE.csv in the folder or in its folder `sweep`, in rising order
  std::vector<ReportPicture>
      pictures;  // of render.json in the folder or in its folder `pictures`, figures first
  std::vector<std::string> warnings;  // files left out, because a link leads out of the folder; a line each
};

// Reads what is there; of records and pictures only what is in the folder, links followed. Throws InputError
// where `path` is no folder, has none of these files, or one is unreadable.
ReportFolder read_report_folder(const std::filesystem::path& path);

}  // namespace hemibake
