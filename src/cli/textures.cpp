#include "cli/print/textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "bake/bake.h"
#include "bake/record.h"
#include "cli/options/bake_options.h"
#include "cli/print/bake.h"
#include "cli/print/warnings.h"
#include "cli/result_folder.h"
#include "core/error.h"
#include "io/bake_file.h"
#include "io/file_context.h"
#include "io/image_io.h"
#include "io/output_file.h"
#include "textures/make_textures.h"
#include "textures/planes.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

// `normal-y` is the textures' green channel here; that of a normal map that is read has this name.
constexpr const char* kNormalMapY = "normals-y";

struct TexturesOptions : BakeOptions {
  TextureSettings textures;
  fs::path folder;
  std::vector<std::string> bake_option_names;
};

// Returns whether a file is a bake; any other is a height map.
bool is_bake(const fs::path& path) {
  const ImageHeader header = read_image_header(path);
  if (!header.provenance.is_object()) return false;
  return std::ranges::any_of(header.channels, [](const std::string& channel) {
    return channel == "ao" || channel == "visibility" || channel == "irradiance.00" || channel == "bent.X" ||
           channel == "normal.X";
  });
}

void check_outputs(const TexturesOptions& options, const std::string& name) {
  const auto is_file = [](const fs::path& path) {
    std::error_code not_there;
    return fs::is_regular_file(path, not_there);
  };
  for (const fs::path& path : texture_paths(options.textures, options.folder, name)) {
    check_bake_output(options.map, path);
    for (const fs::path& input : {fs::path(options.textures.roughness), fs::path(options.textures.metallic)})
      if (is_file(path) && is_file(input) && fs::equivalent(path, input))
        throw InputError(path.string() + ": is an input itself, expected another name for the output");
  }
}

std::vector<WrittenTexture> textures_of_bake(const TexturesOptions& options, const std::string& name,
                                             const Invocation& invocation) {
  for (const std::string& option : options.bake_option_names)
    if (invocation.given(option))
      throw InputError(
          fmt::format("--{}: is of a bake to be made, but {} is made, expected a height map with it", option,
                      options.map.map.string()));
  const BakeFile file = read_bake(options.map.map);
  Provenance provenance = make_provenance(invocation.context.command, options.map.map);
  for (const auto& [key, value] : file.provenance.items())
    provenance[provenance.contains(key) || key == "input_path" ? "bake_" + key : key] = value;
  return with_file_context(options.map.map, [&] {
    return make_textures(file.bake, provenance, options.textures, options.folder, name);
  });
}

void refuse_normal_map_without_y(const TexturesOptions& options) {
  const bool has_map = !options.map.normal_map.empty();
  if (has_map && !options.map.normal_y && !options.bake.preset)
    throw SettingError(fmt::format("the direction of its green channel is not known, expected {{{0}}} up or "
                                   "{{{0}}} down",
                                   kNormalMapY),
                       options.map.normal_map.string());
  if (!has_map && options.map.normal_y)
    throw SettingError(
        fmt::format("{{{}}}: there is no normal map, expected {{normals}} FILE with it", kNormalMapY));
}

std::vector<WrittenTexture> textures_of_map(TexturesOptions& options, const std::string& name,
                                            const Invocation& invocation) {
  bake_only_what_textures_need(options.textures, options.bake);
  refuse_normal_map_without_y(options);
  resolve(options, {invocation.context,
                    [&](const std::string& option) {
                      return option != "outputs" &&
                             invocation.given(option == "normal-y" ? kNormalMapY : option);
                    },
                    invocation.json});
  options.bake.spill_folder = options.folder;
  const LoadedMap map = load_map(options.map, options.bake.normal_length);
  const BakeResult result =
      with_file_context(options.map.map, [&] { return bake(map, options.bake, invocation.context); });
  print_warnings(options.map.map.string(), warnings_of(result));
  return make_textures(result.planes, record_of(options.map, map, result, invocation.context.command),
                       options.textures, options.folder, name);
}

int run_textures(TexturesOptions& options, const Invocation& invocation) {
  resolve_textures(options.textures);
  const bool baked = is_bake(options.map.map);
  const std::string name = options.map.map.stem().string();
  const ResultFolder folder(options.folder);
  check_outputs(options, name);
  const std::vector<WrittenTexture> textures =
      baked ? textures_of_bake(options, name, invocation) : textures_of_map(options, name, invocation);
  invocation.print({{"output", options.folder.string()},
                    {"input", options.map.map.string()},
                    {"textures", json_from_textures(textures, options.textures)}},
                   describe_textures(textures, options.textures, options.folder));
  return 0;
}

// The options of a bake but its outputs and links, which follow from the textures.
std::vector<Field> options_of_bake(TexturesOptions& options) {
  std::vector<Field> fields = bake_options(options);
  std::erase_if(fields, [](const Field& field) { return field.name == "outputs" || field.name == "links"; });
  for (Field& field : fields) {
    if (field.name == "MAP") {
      field.name = "INPUT";
      field.help =
          "a bake (EXR as 'hemibake bake' writes it), or a height map, which is baked first with the "
          "options below: only what the textures need";
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
