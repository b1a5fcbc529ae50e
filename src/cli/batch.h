// Runs a command over many height maps: a line a map; a bad map does not stop the others.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bake/load.h"
#include "bake/settings.h"
#include "cli/options/bake_options.h"
#include "cli/options/command.h"
#include "core/memory_limit.h"
#include "io/provenance.h"

namespace hemibake {

// Holds the result of a command for one map.
struct MapOutcome {
  nlohmann::ordered_json json;
  std::string text;   // of a map by itself
  std::string line;   // of one map among many, without a line break
  int exit_code = 0;  // 0 or 1
};

// Says whether a map is done again whose results are there already.
enum class Again { kSkip, kMake };

// Returns the memory that the bake of a map needs at least, for a MemoryScope; none where it may be done
// already: it is read to see. options: resolved, must outlive what is returned; made: what is there then.
MapNeed need_of_bake(const BakeOptions& options, Again again, const std::filesystem::path& made);

// Replaces the field MAP by one for several maps and folders.
void take_several_maps(std::vector<Field>& fields, std::vector<std::string>& maps);

// Says that a map was done before, with the same settings.
MapOutcome skipped(const std::filesystem::path& map, const std::filesystem::path& output);

// Returns whether arguments name more than one map: several, or a folder.
bool names_many(const std::vector<std::string>& arguments);

// Returns the maps that arguments name; a folder stands for the images in it that are no results, or where
// all are, for its bakes. Throws InputError for a folder without images, and for two maps of one name, whose
// results would be the same files.
std::vector<std::filesystem::path> find_maps(const std::vector<std::string>& arguments);

// Throws InputError where a setting that belongs to one map is given with many.
void refuse_settings_of_one_map(const Invocation& invocation, std::initializer_list<const char*> names);

// Returns what a bake by this version records of its map and settings.
Provenance wanted_record(const LoadedMap& map, const BakeSettings& settings);

// Returns whether an image is there and records everything that is wanted.
bool records(const std::filesystem::path& image, const Provenance& wanted);

// Calls `run_one` for each map and prints its line; bad maps are named where they fail and at the end.
// Returns 0; 1 where a check failed; 2 where a map was bad. Throws Cancelled.
int run_over_maps(const std::vector<std::filesystem::path>& maps, const Invocation& invocation,
                  const std::function<MapOutcome(const std::filesystem::path& map)>& run_one);

}  // namespace hemibake
