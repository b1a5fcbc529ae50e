#include "io/file_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "io/provenance.h"
#include "io/table_io.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

nlohmann::ordered_json recorded_files(const fs::path& record) {
  std::error_code not_there;
  if (!fs::is_regular_file(record, not_there)) return nullptr;
  try {
    const nlohmann::ordered_json json = read_json(record);
    if (json.is_object() && json.contains("files") && json["files"].is_object()) return json["files"];
  } catch (const InputError&) {
  }
  return nullptr;
}

// Returns whether a name stays in the folder of its record or below: a record leads nowhere else.
bool is_inside(const fs::path& name) {
  return !name.empty() && name.is_relative() && std::ranges::find(name, fs::path("..")) == name.end();
}

// Returns whether a JSON file says that it was made of one of the files: its provenance has that one's hash.
bool is_made_of(const fs::path& path, const nlohmann::ordered_json& files) {
  try {
    const nlohmann::ordered_json json = read_json(path);
    const std::string inputs = json.at("provenance").at("input_sha256").get<std::string>();
    return std::ranges::any_of(files, [&](const nlohmann::ordered_json& hash) {
      return hash.is_string() && !hash.get<std::string>().empty() &&
             inputs.find(hash.get<std::string>()) != std::string::npos;
    });
  } catch (const InputError&) {
    return false;
  } catch (const nlohmann::ordered_json::exception&) {
    return false;
  }
}

}  // namespace

nlohmann::ordered_json hashes_of(const std::vector<OutputFile*>& files) {
  nlohmann::ordered_json hashes = nlohmann::ordered_json::object();
  for (OutputFile* file : files) {
    file->finish();
    hashes[valid_utf8(file->path().filename().string())] = sha256_of_file(file->temporary_path());
  }
  return hashes;
}

FileSetState file_set_state(const fs::path& record) {
  FileSetState state;
  const nlohmann::ordered_json files = recorded_files(record);
  state.is_recorded = !files.is_null();
  for (const auto& [name, hash] : files.items()) {
    const fs::path file = record.parent_path() / name;
    std::error_code not_there;
    if (!is_inside(name)) continue;
    if (!fs::is_regular_file(file, not_there))
      state.missing.push_back(name);
    else if (hash != sha256_of_file(file))
      state.changed.push_back(name);
  }
  return state;
}

void check_file_set(const fs::path& record, std::initializer_list<const char*> later) {
  for (const std::string& name : file_set_state(record).changed)
    if (std::ranges::find(later, name) == later.end() ||
        !is_made_of(record.parent_path() / name, recorded_files(record)))
      throw InputError(fmt::format(
          "{}: is not of the run that wrote {}, expected the files of one run; run it again, or remove {}",
          (record.parent_path() / name).string(), record.filename().string(), record.filename().string()));
}

}  // namespace hemibake
