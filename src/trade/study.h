// The trade study: every run against the reference, each in a process of its own, each recorded when it is
// done, so that a study that was stopped goes on where it was.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

#include "io/provenance.h"
#include "surface/surface.h"
#include "trade/reference.h"

namespace hemibake {

struct StudyOptions {
  // Holds reference.exr, reference.json, and runs/ID.json, planes/ID.exr, errors/ID-PLANE.png of the runs.
  std::filesystem::path folder;
  // The map. Called in child processes only: this one must not call parallel_for (trade/child_process.h).
  std::function<Surface()> load;
  // The map and the options that make the surface of it, and the version: a record made from anything else is
  // not used again. Its "command" does not count.
  Provenance provenance;
  ReferenceOptions reference;
};

struct Study {
  nlohmann::ordered_json reference;          // Reference::facts, and "models_on_true_ao" (model_errors_of)
  std::vector<nlohmann::ordered_json> runs;  // score_run, in the order of the ladder
  size_t made_now = 0;                       // runs and reference; the others were on record
};

// Throws Cancelled; what is done by then is on record.
Study run_study(const StudyOptions& options);

}  // namespace hemibake
