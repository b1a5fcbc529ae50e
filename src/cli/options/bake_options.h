// The options that commands which bake have in common.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string_view>
#include <vector>

#include "bake/settings.h"
#include "cli/options/command.h"

namespace hemibake {

struct BakeOptions {
  MapSettings map;
  BakeSettings bake;
  std::filesystem::path links;  // empty: not written
};

// All of them; the second only those that make the map a surface.
std::vector<Field> bake_options(BakeOptions& options);
std::vector<Field> surface_options(MapSettings& map);

// Resolves defaults and refuses combinations that make no sense (bake/settings.h).
void resolve(BakeOptions& options, const Invocation& invocation);

// Fails before the work where `output` cannot be written, or is what the bake reads. suffixes: see
// io/output_file.h.
void check_bake_output(const MapSettings& map, const std::filesystem::path& output,
                       std::initializer_list<std::string_view> suffixes = {});

}  // namespace hemibake
