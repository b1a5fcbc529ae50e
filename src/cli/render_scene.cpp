#include "cli/render_scene.h"

#include <fmt/format.h>

#include <algorithm>

#include "bake/crop.h"
#include "bake/record.h"
#include "bake/retrace.h"
#include "core/context.h"
#include "core/error.h"
#include "curves/curves.h"
#include "fitting/fitted_model.h"
#include "fitting/models.h"
#include "io/file_context.h"
#include "io/fit_file.h"
#include "io/image_io.h"
#include "io/table_io.h"
#include "lighting/light_scene.h"

namespace hemibake {
namespace {

constexpr int kModelBins = 100;

// The settings that a bake was made with.
struct Recorded {
  MapSettings map;
  BakeSettings bake;
};

Albedo read_albedo(const RenderOptions& options, const Bake& bake) {
  if (const auto constant = albedo_from_text(options.albedo)) return {*constant, {}};
  const ImageHeader header = read_image_header(options.albedo);
  if (header.width != bake.width || header.height != bake.height)
    throw InputError(fmt::format("{}: is {} x {} texels, expected {} x {} as the bake is", options.albedo,
                                 header.width, header.height, bake.width, bake.height));
  ColorImage image = read_color_image(options.albedo);
  const bool srgb =
      options.albedo_encoding == "srgb" || (options.albedo_encoding == "auto" && image.stored_as_integers);
  return with_file_context(options.albedo, [&] {
    return make_albedo_map(std::move(image.colors), srgb ? AlbedoEncoding::kSrgb : AlbedoEncoding::kLinear);
  });
}

Sky read_sky(const RenderOptions& options) {
  if (options.sky_file().empty()) return make_uniform_sky();
  const std::filesystem::path path = options.sky_file();
  Sky sky;
  if (options.sky_is_harmonics()) {
    const std::vector<double> numbers = read_numbers(path, 3 * kHarmonics);
    for (size_t i = 0; i < kHarmonics; ++i)
      sky.harmonics[i] = {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
    return sky;
  }
  Grid<glm::vec3> image = read_color_image(path).colors;
  sky = with_file_context(path, [&] { return make_lat_long_sky(std::move(image)); });
  if (options.sky_truth == "sh") sky.lat_long = {};
  return sky;
}

// Returns m = (⟨V⟩ − ⟨V²⟩)/(1 − ⟨V⟩) over the texels, 1 for flat ground.
double mean_escape_of(const Bake& bake) {
  const size_t count = static_cast<size_t>(bake.width) * static_cast<size_t>(bake.height);
  double blocked = 0, seen_and_blocked = 0;
  for (size_t i = 0; i < count; ++i) {
    const double visibility = texel_inputs(bake, i).visibility;
    blocked += 1 - visibility;
    seen_and_blocked += visibility * (1 - visibility);
  }
  return blocked > 0 ? std::clamp(seen_and_blocked / blocked, 0.0, 1.0) : 1;
}

// Returns the model with the constants that it has without fits: g = α, the bounce map's albedo, the
// map's mean escape share, those of 2016 and 2018. Throws InputError where it has none, or the bake has no
// bounce map.
ShadingModel model_without_constants(const RenderOptions& options, ModelKind kind, const Bake& bake) {
  std::optional<AnyModel> model = model_without_fits(kind);
  if (!model)
    throw InputError(fmt::format(
        "--constants: the model {} has none without fits, expected fit or another --model", options.model));
  if (auto* map = std::get_if<BounceMapModel>(&*model)) {
    if (bake.bounce.empty())
      throw InputError(options.bake.string() +
                       ": has no plane bounce, expected the bounce map of a bake with --bounce-albedo");
    map->bounce_albedo = bake.bounce_albedo;
  }
  if (auto* mean = std::get_if<MeanEscapeModel>(&*model))
    if (missing_plane(*mean, bake).empty()) mean->mean_escape = mean_escape_of(bake);
  return {has_model({}, kind) ? options.model : options.model + ", no constants fitted", *model};
}

// Returns the model of --fit, of the bake's own curves, or without fits. Returns none and its `reason` if
// these do not suffice.
std::optional<ShadingModel> find_model(const RenderOptions& options, const Bake& bake, std::string& reason) {
  const ModelKind kind = model_kind_from_string(options.model);
  const auto without = [&] { return model_without_constants(options, kind, bake); };
  if (options.constants == "none" || has_model({}, kind)) return without();
  // The escape α needs no constants: those of a fit, if there is one, are a refinement.
  const bool optional = kind == ModelKind::kVisibilityAo;
  FitFile fits;
  std::filesystem::path path = options.fit;
  if (!path.empty()) {
    fits = read_fits(path);
    if (optional && !has_model(fits.fits, kind)) return without();
  } else {
    path = options.bake;
    try {
      fits.fits = fit_model(options.model, make_curves(bake, kModelBins), Abscissa::kCenter, Weights::kNone);
    } catch (const std::runtime_error& error) {
      throw_if_cancelled();
      if (optional) return without();
      reason = error.what();
      return std::nullopt;
    }
  }
  return with_file_context(path, [&] {
    return ShadingModel{options.model, any_fitted_model(fits.fits, kind)};
  });
}

// Returns the bake's form factors: of its links file, or traced again.
LightTransport transport_of(const RenderOptions& options, const BakeFile& file, const Recorded& recorded,
                            const Surface& surface, const Context& context) {
  LightTransport transport = options.links.empty() ? retrace(recorded.map, recorded.bake, context)
                                                   : transport_from_links(options.links, file);
  const PatchSet patches = patches_of_transport(surface, transport);
  if (transport.final_gather.columns != patches.count)
    throw InputError(fmt::format("{}: has {} patches, expected {} as this version makes of the map",
                                 options.links.string(), transport.final_gather.columns, patches.count));
  return transport;
}

// Lights the scene by sky and sun over the form factors of the bake.
void relight(const LightTransport& transport, const SceneLight& light, size_t stored_bounces,
             RenderedScene& result) {
  ShadedScene& scene = result.scene;
  const int bounces = stored_bounces > 1 ? static_cast<int>(stored_bounces) - 1 : BakeSettings().bounces;
  LitScene lit = light_scene(*scene.surface, transport, scene.albedo, light, bounces);
  scene.sun = std::move(lit.sun);
  scene.truth = std::move(lit.relit);
  result.projection_error = lit.projection_error;
}

}  // namespace

RenderedScene shade_scene(const RenderOptions& options, BakeFile file, const Context& context) {
  RenderedScene result;
  ShadedScene& scene = result.scene;
  const Bake& bake = file.bake;
  scene.albedo = read_albedo(options, bake);
  const SceneLight light{read_sky(options), sun_from_text(options.sun), options.sky_rays};
  const bool runs_again = needs_transport(light, scene.albedo);

  Recorded recorded;
  try {
    recorded = {recorded_map_settings(file.provenance, options.bake),
                recorded_bake_settings(file.provenance, options.bake)};
    scene.surface = load_map(recorded.map).surface;
    const int margin = recorded.bake.margin;
    if (margin > 0) {
      if (runs_again)
        throw InputError(
            fmt::format("{}: is cropped by {} texels, expected a bake of the whole map to light again",
                        options.bake.string(), margin));
      with_file_context(options.bake,
                        [&] { check_margin(margin, scene.surface->width(), scene.surface->height()); });
      scene.surface->heights_m = crop_plane(scene.surface->heights_m, margin);
      scene.surface->normals = crop_plane(scene.surface->normals, margin);
      scene.is_cropped = true;
    }
    if (scene.surface->width() != bake.width || scene.surface->height() != bake.height)
      throw InputError(options.bake.string() + ": its map has another size, expected the bake's");
  } catch (const InputError& error) {
    if (runs_again) throw;
    scene.surface.reset();
    scene.is_cropped = false;
    result.no_map = error.what();
  }

  scene.sky =
      unshaded_sky(light.sky, bake.normals.empty() && scene.surface ? scene.surface->normals : bake.normals,
                   bake.width, bake.height);
  scene.model = find_model(options, bake, result.no_model);
  if (runs_again) {
    relight(transport_of(options, file, recorded, *scene.surface, context), light, bake.irradiance.size(),
            result);
  } else if (!bake.irradiance.empty()) {
    scene.truth = relight_constant(bake.irradiance, scene.albedo.constant);
  }
  scene.bake = std::move(file.bake);
  return result;
}

}  // namespace hemibake
