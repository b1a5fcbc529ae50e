#include "cli/print/textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "bake/bake.h"
#include "bake/crop.h"
#include "bake/record.h"
#include "cli/batch.h"
#include "cli/options/bake_options.h"
#include "cli/print/bake.h"
#include "cli/print/map.h"
#include "cli/print/warnings.h"
#include "cli/result_folder.h"
#include "core/error.h"
#include "core/memory_limit.h"
#include "io/bake_file.h"
#include "io/file_context.h"
#include "io/image_io.h"
#include "io/output_check.h"
#include "io/output_file.h"
#include "textures/make_textures.h"
#include "textures/planes.h"
#include "textures/terrain_layers.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

// `normal-y` is the textures' green channel here; that of a normal map that is read has this name.
constexpr const char* kNormalMapY = "normals-y";

struct TexturesOptions : BakeOptions {
  std::vector<std::string> inputs;
  TextureSettings textures;
  fs::path folder;
  std::vector<std::string> bake_option_names;
};

// Returns whether a file is a bake; any other is a height map, whose reader says what is wrong with it.
bool is_bake(const fs::path& path) {
  if (lower_case_extension(path) != ".exr") return false;
  try {
    const ImageHeader header = read_image_header(path);
    if (!header.provenance.is_object()) return false;
    return std::ranges::any_of(header.channels, [](const std::string& channel) {
      return channel == "ao" || channel == "visibility" || channel == "irradiance.00" ||
             channel == "bent.X" || channel == "normal.X";
    });
  } catch (const InputError&) {
    return false;
  }
}

void check_outputs(const TexturesOptions& options, const std::string& name) {
  const std::vector<fs::path> outputs = texture_paths(options.textures, options.folder, name);
  for (const fs::path& path : outputs) check_output_path(path);
  refuse_overwriting_inputs(outputs, {options.map.map, options.map.normal_map, options.textures.roughness,
                                      options.textures.metallic});
}

void refuse_options_of_a_bake(const TexturesOptions& options, const Invocation& invocation) {
  for (const std::string& option : options.bake_option_names)
    if (invocation.given(option))
      throw InputError(
          fmt::format("--{}: is of a bake to be made, but {} is made, expected a height map with it", option,
                      options.map.map.string()));
}

// Returns how the textures of a bake are made. of_bake: how the bake was.
Provenance record_of_bake(const fs::path& bake, const Provenance& of_bake, std::string_view command) {
  Provenance provenance = make_provenance(command, bake);
  for (const auto& [key, value] : of_bake.items())
    provenance[provenance.contains(key) || key == "input_path" ? "bake_" + key : key] = value;
  return provenance;
}

// Makes the planes of terrain of a map, cropped as its bake.
TerrainPlanes terrain_of(const Surface& surface, const fs::path& map, const TextureSettings& settings,
                         int margin) {
  if (!surface.holes.empty())
    throw InputError(
        map.string() +
        ": has open holes, which horizons do not know, expected --holes fill for maps of terrain");
  const double longer_side_m = surface.texel_size_m * std::max(surface.width(), surface.height());
  if (longer_side_m > kCurvedMapM && !settings.curvature)
    print_warnings(map.string(),
                   {fmt::format("is {:.3g} km long and taken for flat, --curvature lowers far terrain",
                                longer_side_m / 1000)});
  TerrainPlanes planes = make_terrain(surface, terrain_options(settings));
  for (Grid<float>* plane : {&planes.svf, &planes.openness, &planes.negative_openness})
    *plane = crop_plane(*plane, margin);
  for (Grid<float>& plane : planes.horizons) plane = crop_plane(plane, margin);
  return planes;
}

std::vector<WrittenTexture> textures_of_bake(const TexturesOptions& options, const std::string& name,
                                             const Invocation& invocation) {
  const BakeFile file = read_bake(options.map.map);
  const Provenance provenance = record_of_bake(options.map.map, file.provenance, invocation.context.command);
  TerrainPlanes terrain;
  if (options.textures.wants_terrain()) {
    const MapSettings of_bake = recorded_map_settings(file.provenance, options.map.map);
    refuse_overwriting_inputs(texture_paths(options.textures, options.folder, name),
                              {of_bake.map, of_bake.normal_map});
    terrain = terrain_of(load_map(of_bake).surface, of_bake.map, options.textures,
                         recorded_bake_settings(file.provenance, options.map.map).margin);
  }
  return with_file_context(options.map.map, [&] {
    return make_textures({file.bake, terrain}, provenance, options.textures, options.folder, name);
  });
}

// Returns a message with the name that a normal map's green channel has here.
std::string with_names_of_textures(std::string message) {
  const std::string of_bake = "--normal-y";
  for (size_t at = 0; (at = message.find(of_bake, at)) != std::string::npos; at += 1)
    message.replace(at, of_bake.size(), std::string("--") + kNormalMapY);
  return message;
}

void resolve_bake_of_map(TexturesOptions& options, const Invocation& invocation) {
  bake_only_what_textures_need(options.textures, options.bake);
  resolve(options, {invocation.context,
                    [&](const std::string& option) {
                      return option != "outputs" &&
                             invocation.given(option == "normal-y" ? kNormalMapY : option);
                    },
                    invocation.json});
  options.bake.spill_folder = options.folder;
}

// Loads the map that is to be baked. options: their bake is resolved afterwards; name: of the textures.
LoadedMap load_map_to_bake(TexturesOptions& options, Again again, const std::string& name,
                           const Invocation& invocation) {
  try {
    resolve_bake_of_map(options, invocation);
    const fs::path made = texture_paths(options.textures, options.folder, name)[0];
    const MemoryScope memory(options.bake.memory_gib,
                             options.textures.wants_bake() ? need_of_bake(options, again, made) : MapNeed());
    return load_map(options.map, options.bake.normal_length);
  } catch (const SettingError& error) {
    throw InputError(with_names_of_textures(error.with_prefix("--")));
  }
}

std::vector<WrittenTexture> textures_of_map(const TexturesOptions& options, const LoadedMap& map,
                                            const std::string& name, const Invocation& invocation) {
  const int margin = options.bake.margin;
  with_file_context(options.map.map,
                    [&] { check_margin(margin, map.surface.width(), map.surface.height()); });
  TerrainPlanes terrain;
  if (options.textures.wants_terrain())
    terrain = terrain_of(map.surface, options.map.map, options.textures, margin);
  BakeResult result;
  result.settings = options.bake;
  result.texel_size_m = map.surface.texel_size_m;
  result.planes.width = map.surface.width() - 2 * margin;
  result.planes.height = map.surface.height() - 2 * margin;
  if (options.textures.wants_bake())
    result = with_file_context(options.map.map, [&] { return bake(map, options.bake, invocation.context); });
  print_warnings(options.map.map.string(), warnings_of(result));
  return make_textures({result.planes, terrain}, record_of(map, result, invocation.context.command),
                       options.textures, options.folder, name);
}

// Returns whether every texture is there as it would be made again. options: resolved.
// map: where no bake was given.
bool were_made(const TexturesOptions& options, const std::optional<LoadedMap>& map, const std::string& name) {
  Provenance wanted;
  if (!map) {
    wanted = record_of_bake(options.map.map, read_image_header(options.map.map).provenance, "");
    for (const char* elsewhere : {"command", "bake_command", "bake_input_path", "normals_path"})
      wanted.erase(elsewhere);
  } else {
    wanted = wanted_record(*map, options.bake);
  }
  const std::vector<fs::path> paths = texture_paths(options.textures, options.folder, name);
  for (size_t t = 0; t < paths.size(); ++t) {
    record_texture_settings(options.textures, options.textures.kinds[t], wanted);
    if (!records(paths[t], wanted)) return false;
  }
  return true;
}

// Makes the textures of one bake or map. options: its textures resolved.
MapOutcome make_one(TexturesOptions options, Again again, const Invocation& invocation) {
  const std::string name = options.map.map.stem().string();
  check_outputs(options, name);
  std::optional<LoadedMap> map;
  if (is_bake(options.map.map))
    refuse_options_of_a_bake(options, invocation);
  else
    map = load_map_to_bake(options, again, name, invocation);
  if (again == Again::kSkip && were_made(options, map, name)) return skipped(options.map.map, options.folder);
  nlohmann::ordered_json json = {{"output", options.folder.string()}, {"input", options.map.map.string()}};
  if (map) {
    std::vector<std::string> warnings = warnings_of(*map);
    for (std::string& warning : warnings) warning = with_names_of_textures(warning);
    print_warnings(options.map.map.string(), warnings);
    json["map"] = json_from_map(*map);
    json["warnings"] = warnings;
  }
  const std::vector<WrittenTexture> textures =
      map ? textures_of_map(options, *map, name, invocation) : textures_of_bake(options, name, invocation);
  json["textures"] = json_from_textures(textures, options.textures);
  return {json,
          (map ? describe_map(*map) : "") + describe_textures(textures, options.textures, options.folder),
          line_of_textures(textures, options.map.map, options.folder), 0};
}

int make_many(TexturesOptions& options, const Invocation& invocation) {
  refuse_settings_of_one_map(invocation, {"normals"});
  for (const std::string& packed : {options.textures.roughness, options.textures.metallic})
    if (std::error_code not_there; fs::is_regular_file(packed, not_there))
      throw InputError(packed + ": is of one map, expected a number for several maps");
  const std::vector<fs::path> inputs = find_maps(options.inputs);
  const ResultFolder folder(options.folder);
  return run_over_maps(inputs, invocation, [&](const fs::path& input) {
    TexturesOptions of_input = options;
    of_input.map.map = input;
    return make_one(of_input, Again::kSkip, invocation);
  });
}

int run_textures(TexturesOptions& options, const Invocation& invocation) {
  resolve_textures(options.textures);
  if (names_many(options.inputs)) return make_many(options, invocation);
  options.map.map = options.inputs[0];
  const ResultFolder folder(options.folder);
  const MapOutcome outcome = make_one(options, Again::kMake, invocation);
  invocation.print(outcome.json, outcome.text);
  return 0;
}

// The options of a bake but its outputs and links, which follow from the textures.
std::vector<Field> options_of_bake(TexturesOptions& options) {
  std::vector<Field> fields = bake_options(options);
  take_several_maps(fields, options.inputs);
  std::erase_if(fields, [](const Field& field) { return field.name == "outputs" || field.name == "links"; });
  for (Field& field : fields) {
    if (field.name == "MAP") {
      field.name = "INPUT";
      field.help =
          "a bake (EXR as 'hemibake bake' writes it), or a height map, which is baked first with the "
          "options below: only what the textures need; several, or a folder of them: bad ones are named, "
          "done ones skipped";
      continue;
    }
    if (field.name == "normal-y") field.name = kNormalMapY;
    options.bake_option_names.push_back(field.name);
  }
  return fields;
}

}  // namespace

CommandSetup setup_textures() {
  auto options = std::make_shared<TexturesOptions>();
  CommandSetup setup;
  setup.fields = options_of_bake(*options);
  std::vector<Field> more = {shown_as(
      required(output_option(options->folder, "folder for the textures, named after the input; made if new")),
      "DIR")};
  append(more, texture_fields(options->textures));
  setup.fields.insert(setup.fields.begin() + 1, more.begin(), more.end());
  setup.footer =
      "Example: hemibake textures bricks.png -o out --amplitude 0.05 --engine unreal\n"
      "writes out/bricks_BN.png, bricks_N.png and bricks_ORM.png. Light with bounces (--maps\n"
      "visibility,bounce) takes far longer than the others.";
  setup.run = [options](const Invocation& invocation) { return run_textures(*options, invocation); };
  return setup;
}

}  // namespace hemibake
