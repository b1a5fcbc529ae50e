#include "io/output_check.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <optional>
#include <string>

#include "core/error.h"
#include "io/output_file.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

// Identifies what a path leads to: a file by device and number, or, where there is none yet, its folder and
// its name in it.
struct Place {
  dev_t device = 0;
  ino_t number = 0;
  std::string new_name;
  bool operator==(const Place&) const = default;
};

std::optional<Place> place_of(const fs::path& path) {
  struct stat status {};
  if (path.empty()) return std::nullopt;
  if (stat(path.c_str(), &status) == 0) return Place{status.st_dev, status.st_ino, ""};
  const fs::path target = resolve_target(path);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : ".";
  if (stat(folder.c_str(), &status) != 0) return std::nullopt;
  return Place{status.st_dev, status.st_ino, target.filename().string()};
}

}  // namespace

void refuse_overwriting_inputs(const std::vector<fs::path>& outputs, const std::vector<fs::path>& inputs) {
  for (size_t i = 0; i < outputs.size(); ++i) {
    const std::optional<Place> place = place_of(outputs[i]);
    if (!place) continue;
    for (const fs::path& input : inputs)
      if (place_of(input) == place)
        throw InputError(fmt::format("{}: is the input {}, expected another name for the output",
                                     outputs[i].string(),
                                     input == outputs[i] ? "itself" : input.string() + " itself"));
    for (size_t j = 0; j < i; ++j)
      if (place_of(outputs[j]) == place)
        throw InputError(fmt::format("{}: is the same file as {}, expected an output of its own each",
                                     outputs[i].string(), outputs[j].string()));
  }
}

}  // namespace hemibake
