#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/render_options.h"
#include "cli/render_scene.h"
#include "cli/result_folder.h"
#include "core/constants.h"
#include "core/parallel.h"
#include "io/bake_file.h"
#include "io/output_file.h"
#include "io/picture_text.h"
#include "io/table_io.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRecord = "render.json";

// Pictures that an earlier run left and this one does not make would pass for this one's.
void remove_earlier_pictures(const fs::path& folder) {
  if (!fs::is_regular_file(folder / kRecord)) return;
  nlohmann::ordered_json earlier;
  try {
    earlier = read_json(folder / kRecord);
    for (const auto& picture : earlier.at("pictures"))
      for (const auto& file : picture.at("files")) {
        const fs::path name = file.get<std::string>();
        if (name == name.filename()) fs::remove(folder / name);
      }
  } catch (const nlohmann::json::exception&) {
    throw InputError((folder / kRecord).string() +
                     ": is not the record of a render, expected another folder");
  }
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
  BakeFile file = read_bake(options.bake);
  show_holes_as_open_ground(file.bake);
  const Provenance provenance = make_provenance(invocation.context.command, options.bake);
  const ResultFolder folder(options.folder);
  check_output_path(options.folder / kRecord);

  const RenderedScene rendered = shade_scene(options, std::move(file), invocation.context);
  const SceneImages shaded = make_scene_images(rendered.scene, options.picture);
  remove_earlier_pictures(options.folder);
  Gallery gallery(options.folder, provenance);
  draw(options, rendered.scene, shaded, gallery);

  nlohmann::ordered_json json = provenance;
  json["light"] = json_from_light(rendered);
  json["exposure_ev"] = shaded.exposure_ev;
  json["errors"] = errors_of(shaded);
  json.update(gallery.json());
  write_json(options.folder / kRecord, json);
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
