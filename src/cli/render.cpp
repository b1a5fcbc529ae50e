#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "bake/record.h"
#include "cli/render_options.h"
#include "cli/render_scene.h"
#include "cli/result_folder.h"
#include "core/constants.h"
#include "core/parallel.h"
#include "io/bake_file.h"
#include "io/file_set.h"
#include "io/image_io.h"
#include "io/output_check.h"
#include "io/output_file.h"
#include "io/picture_text.h"
#include "io/table_io.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRecord = "render.json";

// Returns whether an image says that a render made it.
bool is_rendered(const fs::path& image) {
  try {
    const Provenance made = read_image_header(image).provenance;
    return made.is_object() && made.value("command", "").starts_with("hemibake render");
  } catch (const InputError&) {
    return false;
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

// Returns the pictures that an earlier run recorded in the folder and that say themselves what they are. A
// record can say anything: what it names is not removed for that alone.
std::vector<fs::path> earlier_pictures(const fs::path& folder) {
  const fs::path record = folder / kRecord;
  std::error_code not_there;
  if (!fs::exists(record, not_there)) return {};
  const nlohmann::ordered_json earlier = read_json(record);
  if (!earlier.is_object() || !earlier.contains("pictures") || !earlier["pictures"].is_array())
    throw InputError(record.string() + ": is not the record of a render, expected another folder");
  std::vector<fs::path> pictures;
  for (const auto& picture : earlier["pictures"]) {
    if (!picture.is_object() || !picture.contains("files") || !picture["files"].is_array()) continue;
    for (const auto& file : picture["files"]) {
      if (!file.is_string()) continue;
      const fs::path name = file.get<std::string>();
      const fs::path path = folder / name;
      if (name == name.filename() && fs::is_regular_file(fs::symlink_status(path, not_there)) &&
          is_rendered(path))
        pictures.push_back(path);
    }
  }
  return pictures;
}

// Removes the pictures of an earlier run that this one did not make: they would pass for this one's.
void remove_others(const std::vector<fs::path>& earlier, const std::vector<fs::path>& written) {
  for (const fs::path& picture : earlier) {
    std::error_code not_there;
    if (std::ranges::find(written, picture) == written.end()) fs::remove(picture, not_there);
  }
}

// Refuses a bake and fits of one folder that are not of one run.
void check_run_of(const RenderOptions& options) {
  std::error_code not_there;
  const fs::path folder = fs::absolute(options.bake, not_there).parent_path();
  if (fs::equivalent(folder, fs::absolute(options.fit, not_there).parent_path(), not_there))
    check_file_set(folder / "check.json", {"fit.json"});
}

// Returns every file that a render reads; names that are no files are left out when they are compared.
std::vector<fs::path> inputs_of(const RenderOptions& options, const Provenance& of_bake) {
  std::vector<fs::path> inputs = {options.bake, options.links, options.fit, options.sky_file(),
                                  options.albedo};
  try {
    const MapSettings map = recorded_map_settings(of_bake, options.bake);
    inputs.push_back(map.map);
    inputs.push_back(map.normal_map);
  } catch (const InputError&) {
    // Its map is not there, and so nothing of it can be written over.
  }
  return inputs;
}

nlohmann::ordered_json json_from_error(const PictureError& error) {
  return {{"bias_over_mean", error.bias}, {"rms_over_mean", error.rms}, {"largest_over_mean", error.largest}};
}

// Says how the scene was lit, and how well that is known.
nlohmann::ordered_json json_from_light(const RenderedScene& rendered) {
  nlohmann::ordered_json light;
  if (!rendered.no_map.empty()) light["map"] = rendered.no_map;
  if (!rendered.no_model.empty()) light["model"] = rendered.no_model;
  if (rendered.projection_error)
    light["sky_projected_against_traced"] = json_from_error(*rendered.projection_error);
  if (const std::optional<Relit>& truth = rendered.scene.truth) {
    light["bounces"] = truth->bounces.size() - 1;
    light["rest_of_series_mean_over_pi"] = truth->mean_rest / kPi;
    light["rest_of_series_largest_over_pi"] = truth->largest_rest / kPi;
  }
  return light;
}

nlohmann::ordered_json errors_of(const SceneImages& shaded) {
  nlohmann::ordered_json errors = nlohmann::ordered_json::object();
  if (shaded.truth.empty()) return errors;
  for (const SceneImage* image : shaded.approximations())
    if (!image->light.empty())
      errors[image->name] = json_from_error(picture_error(image->light, shaded.truth));
  return errors;
}

void draw(const RenderOptions& options, const ShadedScene& scene, const SceneImages& shaded,
          Gallery& gallery) {
  if (options.wants("light")) add_triptych(shaded, gallery);
  if (options.wants("differences")) add_differences(shaded, gallery);
  if (options.wants("bounces")) add_bounces(scene, options.picture, gallery);
  if (options.wants("saturation")) add_saturation(scene, shaded, gallery);
  if (options.wants("planes")) add_planes(scene, gallery);
  if (options.wants("estimators")) add_estimators(scene, gallery);
  if (options.wants("views")) add_views(scene, shaded, options.picture, gallery);
  if (!has_font()) gallery.report_missing("captions", "no font was found, expected fonts-dejavu-core");
}

std::string describe(const RenderOptions& options, const nlohmann::ordered_json& json,
                     const Gallery& gallery) {
  std::string text =
      fmt::format("{}: {:.1f} cpu-s\n", options.folder.string(), json["cpu_seconds"].get<double>());
  for (const auto& [name, error] : json["errors"].items())
    text +=
        fmt::format("{:15} against ground truth: {:+.2f} % in mean luminance, rms {:.2f} %\n", name,
                    100 * error["bias_over_mean"].get<double>(), 100 * error["rms_over_mean"].get<double>());
  return text + gallery.text();
}

int run_render(RenderOptions& options, const Invocation& invocation) {
  resolve(options);
  if (!options.fit.empty()) check_run_of(options);
  BakeFile file = read_bake(options.bake);
  show_holes_as_open_ground(file.bake);
  const Provenance provenance = make_provenance(invocation.context.command, options.bake);
  const ResultFolder folder(options.folder);
  check_output_path(options.folder / kRecord);
  const std::vector<fs::path> inputs = inputs_of(options, file.provenance);
  refuse_overwriting_inputs({options.folder / kRecord}, inputs);
  const std::vector<fs::path> earlier = earlier_pictures(options.folder);

  const RenderedScene rendered = shade_scene(options, std::move(file), invocation.context);
  const SceneImages shaded = make_scene_images(rendered.scene, options.picture);
  OutputSet files;
  OutputFile& record = files.add(options.folder / kRecord);
  Gallery gallery(options.folder, provenance, files);
  draw(options, rendered.scene, shaded, gallery);
  refuse_overwriting_inputs(files.paths(), inputs);

  nlohmann::ordered_json json = provenance;
  json["light"] = json_from_light(rendered);
  json["exposure_ev"] = shaded.exposure_ev;
  json["errors"] = errors_of(shaded);
  json.update(gallery.json());
  json["files"] = hashes_of(gallery.files());
  write_json(record, json);
  files.commit();
  remove_others(earlier, files.paths());
  json["cpu_seconds"] = process_cpu_seconds();
  invocation.print(json, describe(options, json, gallery));
  return 0;
}

}  // namespace

CommandSetup setup_render() {
  auto options = std::make_shared<RenderOptions>();
  CommandSetup setup;
  setup.fields = render_fields(*options);
  setup.run = [options](const Invocation& invocation) { return run_render(*options, invocation); };
  return setup;
}

}  // namespace hemibake
