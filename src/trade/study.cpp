#include "trade/study.h"

#include <algorithm>

#include "core/constants.h"
#include "core/context.h"
#include "core/error.h"
#include "core/progress.h"
#include "io/table_io.h"
#include "trade/child_process.h"
#include "trade/error_picture.h"
#include "trade/plane_file.h"
#include "trade/scored_run.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

// Of what the records hold and how they are made: another number, and those on disk are made again.
constexpr int kRecordFormat = 1;

fs::path reference_planes(const StudyOptions& options) { return options.folder / "reference.exr"; }

// What decides the result of the reference, and with it of every run.
ordered_json study_key(const StudyOptions& options) {
  ordered_json key = options.provenance;
  key.erase("command");
  key["record_format"] = kRecordFormat;
  key["azimuths_ao"] = top_ao_azimuths(options.reference.effort);
  key["azimuths_light"] = top_light_azimuths(options.reference.effort);
  key["memory_bytes"] = options.reference.memory_bytes;
  return key;
}

// The result on record under this key, or null. What cannot be read is as good as not there.
ordered_json find_record(const fs::path& path, const ordered_json& key) {
  if (!fs::is_regular_file(path)) return nullptr;
  try {
    const ordered_json record = read_json(path);
    if (record.is_object() && record.contains("key") && record.contains("result") && record["key"] == key)
      return record["result"];
  } catch (const InputError&) {
  }
  return nullptr;
}

// The result of `work`, in a child, unless it is on record already.
ordered_json recorded(const fs::path& path, const ordered_json& key, const std::string& what,
                      size_t& made_now, const std::function<ordered_json()>& work) {
  ordered_json result = find_record(path, key);
  if (!result.is_null()) return result;
  result = ordered_json::parse(run_in_child(what, [&work] { return work().dump(); }));
  write_json(path, {{"key", key}, {"result", result}});
  ++made_now;
  return result;
}

ordered_json make_reference_files(const StudyOptions& options) {
  Reference reference = make_reference(options.load(), options.reference);
  write_planes(reference_planes(options), reference.planes, options.provenance);
  reference.facts["models_on_true_ao"] =
      model_errors_of(reference.planes, reference.fitted, reference.planes);
  return reference.facts;
}

ordered_json make_run(const StudyOptions& options, const TradeRun& run, const ordered_json& reference) {
  const Surface surface = options.load();
  const RunPlanes truth = read_run_planes(reference_planes(options), surface.width(), surface.height());
  Grid<float> direct = truth.cosine;
  for (float& value : direct.values) value *= static_cast<float>(kPi);
  const MeasuredRun measured = measure_run(run, surface, direct);
  if (run.representative || run.keeps_planes) {
    Provenance provenance = options.provenance;
    provenance["run"] = run.id();
    write_planes(options.folder / "planes" / (run.id() + ".exr"), measured.planes, provenance);
    write_error_pictures(options.folder / "errors", run.id(), measured.planes, truth, provenance);
  }
  return score_run(run, measured, fitted_from_json(reference.at("models")), truth);
}

// The reference on record counts only with its planes.
void forget_reference_without_planes(const StudyOptions& options, const fs::path& record) {
  if (!fs::is_regular_file(reference_planes(options))) fs::remove(record);
}

}  // namespace

Study run_study(const StudyOptions& options) {
  ordered_json key = study_key(options);
  const fs::path reference_record = options.folder / "reference.json";
  forget_reference_without_planes(options, reference_record);

  Study study;
  study.reference = recorded(reference_record, key, "reference", study.made_now,
                             [&options] { return make_reference_files(options); });
  for (const char* name : {"runs", "planes", "errors"}) fs::create_directories(options.folder / name);
  const std::vector<TradeRun> ladder =
      make_ladder(options.reference.effort, study.reference.at("can_halve").get<bool>());
  Progress progress("trade", ladder.size(), "run");
  for (const TradeRun& run : ladder) {
    throw_if_cancelled();
    // The reference is the same bytes whenever it is made from this key.
    key["method"] = run.method;
    key["settings"] = run.settings;
    const fs::path record = options.folder / "runs" / (run.id() + ".json");
    study.runs.push_back(recorded(record, key, run.id(), study.made_now,
                                  [&] { return make_run(options, run, study.reference); }));
    progress.advance(1);
  }
  return study;
}

}  // namespace hemibake
