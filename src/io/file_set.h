// Files that one command wrote together. One of them, the record, is JSON and names the others, beside it or
// in folders below, with their SHA-256 under "files": files of two runs, as a run leaves that was killed
// between two names, are told by it.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "io/output_file.h"

namespace hemibake {

// Returns {"NAME": "SHA-256"} of files that are written; finishes them.
nlohmann::ordered_json hashes_of(const std::vector<OutputFile*>& files);

// How the files beside a record differ from what it says.
struct FileSetState {
  bool is_recorded = false;          // the record is there and names files
  std::vector<std::string> changed;  // names of files that are there with other bytes
  std::vector<std::string> missing;  // names of files that are not there
};

// Compares the files beside a record with it. A record that is not there, does not read or names no files
// gives none: its reader says what is wrong with it.
FileSetState file_set_state(const std::filesystem::path& record);

// Throws InputError where a file beside a record is of another run. later: names of JSON files that may
// be newer, where their provenance says that they were made of a file of the run.
void check_file_set(const std::filesystem::path& record, std::initializer_list<const char*> later = {});

}  // namespace hemibake
