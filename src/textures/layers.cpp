#include "textures/layers.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "core/parallel.h"
#include "textures/bounce_map.h"
#include "textures/light.h"
#include "textures/terrain_layers.h"

namespace hemibake {
namespace {

constexpr size_t kGrain = 16384;
constexpr double kDetail = 1;  // of the mask: all of it

using TexelValue = std::function<double(size_t texel)>;
using TexelVector = std::function<glm::dvec3(size_t texel)>;

// value: any finite number; is clamped to 0..1.
Layer layer_of(const Bake& bake, const char* channel, const TexelValue& value) {
  Layer layer{channel, Grid<float>(bake.width, bake.height)};
  parallel_for(layer.values.size(), kGrain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) layer.values[i] = static_cast<float>(std::clamp(value(i), 0.0, 1.0));
  });
  return layer;
}

// Encodes vectors of at most unit length, x right, y down the rows, z up: 0..1 for −1..1.
std::vector<Layer> encode_vectors(const Bake& bake, NormalY convention, const TexelVector& vector) {
  const glm::dvec3 scale(0.5, convention == NormalY::kDown ? 0.5 : -0.5, 0.5);
  std::vector<Layer> layers;
  for (const char* channel : {"R", "G", "B"})
    layers.push_back({channel, Grid<float>(bake.width, bake.height)});
  parallel_for(layers[0].values.size(), kGrain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const glm::dvec3 encoded = glm::clamp(0.5 + scale * vector(i), 0.0, 1.0);
      for (int c = 0; c < 3; ++c) layers[static_cast<size_t>(c)].values[i] = static_cast<float>(encoded[c]);
    }
  });
  return layers;
}

// Returns the length L ≤ 1 of the bent normal, by which L · (normal · bent) = V.
double length_for_visibility(const Bake& bake, size_t texel) {
  const double cosine = glm::dot(glm::dvec3(bake.normals[texel]), glm::dvec3(bake.bent_normals[texel]));
  const double visibility = visibility_at(bake, texel);
  if (cosine > visibility) return visibility / cosine;
  return visibility > 0 ? 1 : 0;
}

glm::dvec3 bent_at(const Bake& bake, BentLength length, size_t texel) {
  const glm::dvec3 bent(bake.bent_normals[texel]);
  if (length == BentLength::kVisibility) return length_for_visibility(bake, texel) * bent;
  if (length == BentLength::kAo) return static_cast<double>(bake.visible_fraction[texel]) * bent;
  return bent;
}

TexelValue occlusion_of(const Bake& bake, TextureKind kind) {
  if (kind == TextureKind::kAo)
    return [&bake](size_t i) { return static_cast<double>(bake.visible_fraction[i]); };
  if (kind == TextureKind::kBounce) return [&bake](size_t i) { return bounce_at(bake, i); };
  return [&bake](size_t i) { return visibility_at(bake, i); };
}

std::vector<Layer> irradiance_layers(const Bake& bake, const std::vector<double>& albedo) {
  constexpr std::array kColors = {"R", "G", "B"};
  std::vector<Layer> layers;
  for (size_t c = 0; c < albedo.size(); ++c)
    layers.push_back(layer_of(bake, albedo.size() == 1 ? "Y" : kColors.at(c),
                              [&](size_t i) { return irradiance_at(bake, i, albedo[c]); }));
  return layers;
}

std::vector<Layer> packed_layers(const Bake& bake, const TextureSettings& settings, TextureKind kind,
                                 const PackedInputs& packed) {
  const TexelValue occlusion = occlusion_of(bake, settings.occlusion);
  if (kind == TextureKind::kOrm)
    return {layer_of(bake, "R", occlusion), {"G", packed.roughness}, {"B", packed.metallic}};
  return {{"R", packed.metallic},
          layer_of(bake, "G", occlusion),
          layer_of(bake, "B", [](size_t) { return kDetail; }),
          layer_of(bake, "A", [&](size_t i) { return 1 - static_cast<double>(packed.roughness[i]); })};
}

Grid<float> read_packed_input(const std::string& name, const std::string& value, int width, int height) {
  double number = 0;
  const auto [stop, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  if (error == std::errc() && stop == value.data() + value.size()) {
    if (!(number >= 0 && number <= 1))
      throw SettingError(fmt::format("{{{}}}: {}, expected a number from 0 to 1 or an image", name, value));
    return {width, height, static_cast<float>(number)};
  }
  Grid<float> image = read_height_map(value);
  if (image.width != width || image.height != height)
    throw InputError(fmt::format("{}: has {} x {} texels, expected the {} x {} of the textures", value,
                                 image.width, image.height, width, height));
  for (const float texel : image.values)
    if (!(texel >= 0 && texel <= 1))
      throw InputError(fmt::format("{}: holds {}, expected a {} from 0 to 1", value, texel, name));
  return image;
}

std::string describe_occlusion(const Bake& bake, TextureKind kind) {
  if (kind == TextureKind::kAo) return "uniform visible fraction";
  if (kind == TextureKind::kBounce)
    return fmt::format("irradiance over pi, all bounces at albedo {:g}", bounce_albedo_of(bake));
  return "cosine-weighted visible fraction, E0/pi";
}

std::string describe_bent(BentLength length) {
  std::string text = "mean direction of the visible sky, all its directions of one weight";
  if (length == BentLength::kVisibility) text += "; normal . bent is the cosine-weighted visible fraction";
  if (length == BentLength::kAo) text += "; as long as the uniform visible fraction";
  return text;
}

}  // namespace

PackedInputs read_packed_inputs(const TextureSettings& settings, int width, int height) {
  if (!settings.wants(TextureKind::kOrm) && !settings.wants(TextureKind::kMask)) return {};
  return {read_packed_input("roughness", settings.roughness, width, height),
          read_packed_input("metallic", settings.metallic, width, height)};
}

std::vector<Layer> make_layers(const Bake& bake, const TextureSettings& settings, TextureKind kind,
                               const PackedInputs& packed) {
  switch (kind) {
    case TextureKind::kVisibility:
    case TextureKind::kAo:
    case TextureKind::kBounce:
      return {layer_of(bake, "Y", occlusion_of(bake, kind))};
    case TextureKind::kBounceMap:
      return {layer_of(bake, "R", occlusion_of(bake, TextureKind::kVisibility)),
              layer_of(bake, "G", occlusion_of(bake, TextureKind::kBounce)),
              {"B", Grid<float>(bake.width, bake.height)}};
    case TextureKind::kBent:
      return encode_vectors(bake, *settings.normal_y,
                            [&](size_t i) { return bent_at(bake, settings.bent_length, i); });
    case TextureKind::kNormal:
      return encode_vectors(bake, *settings.normal_y, [&](size_t i) { return glm::dvec3(bake.normals[i]); });
    case TextureKind::kIrradiance:
      return irradiance_layers(bake, settings.albedo);
    default:
      break;
  }
  return packed_layers(bake, settings, kind, packed);
}

bool chooses_steps(const Bake& bake, const TextureSettings& settings, TextureKind kind) {
  if (settings.coding.format != TextureFormat::kPng8 || settings.coding.dither || !knows_mapped_light(bake))
    return false;
  if (kind == TextureKind::kBounceMap) return true;
  return (kind == TextureKind::kVisibility || kind == TextureKind::kBounce) &&
         settings.wants(TextureKind::kVisibility) && settings.wants(TextureKind::kBounce);
}

std::string describe_texture(const Bake& bake, const TextureSettings& settings, TextureKind kind) {
  if (is_terrain(kind)) return describe_terrain_texture(settings, kind);
  const bool chosen = chooses_steps(bake, settings, kind);
  switch (kind) {
    case TextureKind::kVisibility:
      return describe_occlusion(bake, kind) +
             (chosen ? "; bytes chosen together with the bounce texture's" : "");
    case TextureKind::kBounce:
      return describe_occlusion(bake, kind) +
             (chosen ? "; bytes chosen together with the visibility texture's" : "");
    case TextureKind::kBounceMap:
      return fmt::format("R: {}; G: {}{}", describe_occlusion(bake, TextureKind::kVisibility),
                         describe_occlusion(bake, TextureKind::kBounce),
                         chosen ? "; bytes chosen together" : "");
    case TextureKind::kBent:
      return describe_bent(settings.bent_length);
    case TextureKind::kNormal:
      return "shading normal";
    case TextureKind::kIrradiance:
      return fmt::format("irradiance over pi, all bounces at albedo {:g}", fmt::join(settings.albedo, ","));
    case TextureKind::kOrm:
      return fmt::format("R: {}; G: roughness; B: metallic", describe_occlusion(bake, settings.occlusion));
    case TextureKind::kMask:
      return fmt::format("R: metallic; G: {}; B: detail; A: smoothness",
                         describe_occlusion(bake, settings.occlusion));
    default:
      return describe_occlusion(bake, kind);
  }
}

}  // namespace hemibake
