// The trade study: every run against the reference, each in a process of its own.
//
// Each is recorded when it is done, so that an interrupted study resumes.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "io/provenance.h"
#include "surface/surface.h"
#include "trade/reference.h"
#include "trade/scored_run.h"

namespace hemibake {

struct StudyOptions {
  // Holds reference.exr, reference.json, and runs/ID.json, planes/ID.exr, errors/ID-PLANE.png of the runs.
  std::filesystem::path folder;
  // Loads the map. Called in child processes only: this one must not call parallel_for (child_process.h).
  std::function<Surface()> load;
  // The map, the options that make its surface, and the version. Records made from anything else are made
  // again. Its "command" does not count.
  Provenance provenance;
  ReferenceOptions reference;
};

struct Study {
  ReferenceFacts reference;
  std::vector<ScoredRun> runs;  // in the order of the sweep
  size_t made_now = 0;          // runs and reference; the others were on record
};

// Makes every run of the sweep that is not on record. Throws Cancelled; completed runs stay on record.
Study run_study(const StudyOptions& options);

}  // namespace hemibake
