#include "cli/options/bake_options.h"

#include <algorithm>
#include <array>

#include "io/output_check.h"
#include "io/output_file.h"

namespace hemibake {
namespace {

constexpr std::array<std::string_view, 7> kGroups = {"",      "Map",   "Surface", "Tracing",
                                                     "March", "Light", "Output"};

}  // namespace

std::vector<Field> bake_options(BakeOptions& options) {
  std::vector<Field> fields = map_fields(options.map);
  append(fields, bake_fields(options.bake));
  fields.push_back(in_group(
      shown_as(option("links", file(options.links), "write the form-factor links too, HDF5"), "FILE.h5"),
      "Output"));
  std::ranges::stable_sort(fields, {},
                           [](const Field& field) { return std::ranges::find(kGroups, field.group); });
  return fields;
}

std::vector<Field> surface_options(MapSettings& map) {
  std::vector<Field> fields = map_fields(map);
  std::erase_if(fields, [](const Field& field) { return field.group == "March"; });
  return fields;
}

void resolve(BakeOptions& options, const Invocation& invocation) {
  options.bake.trace_form_factors = options.bake.keep_transport = !options.links.empty();
  resolve_defaults(options.map, options.bake, invocation.given);
  validate(options.map, options.bake, invocation.given);
}

void check_bake_output(const MapSettings& map, const std::filesystem::path& output,
                       std::initializer_list<std::string_view> suffixes) {
  check_output_path(output, suffixes);
  refuse_overwriting_inputs({output}, {map.map, map.normal_map});
}

}  // namespace hemibake
