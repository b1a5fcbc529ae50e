#include "trade/study.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "core/constants.h"
#include "core/context.h"
#include "core/error.h"
#include "core/progress.h"
#include "io/json_text.h"
#include "io/table_io.h"
#include "trade/child_process.h"
#include "trade/error_picture.h"
#include "trade/plane_file.h"
#include "trade/record.h"
#include "trade/scored_run.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

// Version of what records hold and how they are made: records of another version are made again.
constexpr int kRecordFormat = 1;

fs::path reference_planes(const StudyOptions& options) { return options.folder / "reference.exr"; }

// Returns all that decides the reference and with it every run.
ordered_json study_key(const StudyOptions& options) {
  ordered_json key = options.provenance;
  key.erase("command");
  key["record_format"] = kRecordFormat;
  key["azimuths_ao"] = top_ao_azimuths(options.reference.effort);
  key["azimuths_light"] = top_light_azimuths(options.reference.effort);
  key["memory_bytes"] = options.reference.memory_bytes;
  return key;
}

// Returns the result on record under this key; none where it cannot be read.
template <class Result>
std::optional<Result> find_record(const fs::path& path, const ordered_json& key,
                                  Result (*from)(const JsonReader&)) {
  std::error_code not_there;
  if (!fs::is_regular_file(path, not_there)) return std::nullopt;
  try {
    const ordered_json record = read_json(path);
    if (record.is_object() && record.value("key", ordered_json()) == key)
      return from(JsonReader(record, path.string()).at("result"));
  } catch (const InputError&) {
  }
  return std::nullopt;
}

struct RecordPlace {
  fs::path path;
  std::string what;  // of the errors of a child
};

// Returns the result of `work`, done in a child unless it is on record already.
// from: reads it back.
template <class Result>
Result recorded(const RecordPlace& place, const ordered_json& key, size_t& made_now,
                Result (*from)(const JsonReader&), const std::function<Result()>& work) {
  if (const std::optional<Result> found = find_record(place.path, key, from)) return *found;
  // That of another study must not pass for what the work writes beside it, where this one is killed.
  std::error_code not_there;
  fs::remove(place.path, not_there);
  const std::string text = run_in_child(place.what, [&work] { return ordered_json(work()).dump(); });
  const ordered_json result = parse_json(text, place.what);
  write_json(place.path, {{"key", key}, {"result", result}});
  ++made_now;
  return from(JsonReader(result, place.what));
}

ReferenceFacts make_reference_files(const StudyOptions& options) {
  const Reference reference = make_reference(options.load(), options.reference);
  write_planes(reference_planes(options), reference.planes, options.provenance);
  return reference.facts;
}

ScoredRun make_run(const StudyOptions& options, const TradeRun& run, const FittedModels& models) {
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
  return score_run(run, measured, models, truth);
}

// Removes the reference's record where its planes are missing.
void forget_reference_without_planes(const StudyOptions& options, const fs::path& record) {
  std::error_code not_there;
  if (!fs::is_regular_file(reference_planes(options), not_there)) fs::remove(record, not_there);
}

void make_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error)
    throw InputError(fmt::format("{}: could not make the folder: {}", path.string(), error.message()));
}

}  // namespace

Study run_study(const StudyOptions& options) {
  ordered_json key = study_key(options);
  const fs::path reference_record = options.folder / "reference.json";
  forget_reference_without_planes(options, reference_record);

  Study study;
  study.reference =
      recorded<ReferenceFacts>({reference_record, "reference"}, key, study.made_now, reference_facts_from,
                               [&options] { return make_reference_files(options); });
  for (const char* name : {"runs", "planes", "errors"}) make_folder(options.folder / name);
  const std::vector<TradeRun> sweep = make_sweep(options.reference.effort, study.reference.can_halve);
  Progress progress("trade", sweep.size(), "run");
  for (const TradeRun& run : sweep) {
    throw_if_cancelled();
    // The reference is the same bytes whenever it is made from this key.
    key["method"] = run.method;
    key["settings"] = json_from_settings(run.settings);
    const fs::path record = options.folder / "runs" / (run.id() + ".json");
    study.runs.push_back(recorded<ScoredRun>({record, run.id()}, key, study.made_now, scored_run_from,
                                             [&] { return make_run(options, run, study.reference.models); }));
    progress.advance(1);
  }
  return study;
}

}  // namespace hemibake
