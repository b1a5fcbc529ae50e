#include "textures/settings.h"

#include <fmt/format.h>

#include <algorithm>

#include "bake/settings.h"
#include "core/error.h"
#include "textures/engines.h"

namespace hemibake {
namespace {

const std::vector<std::string> kNames = {
    "visibility",        "ao",      "bounce", "bounce-map", "bent", "normal", "irradiance", "svf", "openness",
    "negative-openness", "horizon", "orm",    "mask"};

constexpr int kMostHorizonAzimuths = 3600;

std::vector<std::string> format_names() {
  std::vector<std::string> names;
  for (const TextureFormatInfo& format : texture_formats()) names.emplace_back(format.name);
  return names;
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> words{""};
  for (const char c : text)
    if (c == ',')
      words.emplace_back();
    else
      words.back() += c;
  return words;
}

// Takes several words as one that commas separate: the map may then follow it on a command line.
Value joined_by_commas(Value value) {
  value.fewest = value.most = 1;
  value.separated = false;
  value.set = [set = std::move(value.set)](const std::vector<std::string>& words) {
    set(split(words.at(0)));
  };
  return value;
}

// Takes the number after "horizon:" out of the words.
Value with_horizon_azimuths(Value value, int& azimuths) {
  value.set = [set = std::move(value.set), &azimuths](std::vector<std::string> words) {
    int wanted = azimuths;
    const Value count = whole(wanted, 1, kMostHorizonAzimuths);
    for (std::string& word : words)
      if (word.starts_with("horizon:")) {
        count.set({word.substr(8)});
        word.resize(7);
      }
    set(words);
    azimuths = wanted;
  };
  return value;
}

Field texture_field(std::string name, Value value, std::string help) {
  Field field;
  field.name = std::move(name);
  field.key = "texture_" + field.name;
  std::ranges::replace(field.key, '-', '_');
  field.group = "Textures";
  field.value = std::move(value);
  field.help = std::move(help);
  return field;
}

// Keeps a field out of the record: what it sets is recorded otherwise, or differs from texture to texture.
Field unrecorded(Field field) {
  field.key.clear();
  return field;
}

// Records a field only where there are textures of terrain.
Field of_terrain(Field field, const TextureSettings& settings) {
  field.recorded = [&settings, get = field.value.get] { return settings.wants_terrain() && get(); };
  return field;
}

Field shown_as(Field field, std::string placeholder) {
  field.placeholder = std::move(placeholder);
  return field;
}

void resolve_suffixes(TextureSettings& settings) {
  for (const std::string& word : settings.suffix_words) {
    const size_t equals = word.find('=');
    const auto kind = std::ranges::find(kNames, word.substr(0, equals));
    const std::string suffix = equals == std::string::npos ? "" : word.substr(equals + 1);
    if (kind == kNames.end() || suffix.empty())
      throw SettingError(fmt::format(
          "{{suffix}}: '{}', expected the name of a texture and its suffix, as visibility=_AO", word));
    if (suffix.find('/') != std::string::npos)
      throw SettingError(
          fmt::format("{{suffix}}: '{}' names a folder, expected the end of a file's name", word));
    settings.suffixes.at(static_cast<size_t>(kind - kNames.begin())) = suffix;
  }
}

void resolve_kinds(TextureSettings& settings) {
  std::vector<TextureKind>& kinds = settings.kinds;
  if (kinds.empty()) {
    if (settings.packing == Packing::kNone) kinds.push_back(TextureKind::kVisibility);
    kinds.insert(kinds.end(), {TextureKind::kBent, TextureKind::kNormal});
  }
  if (settings.packing == Packing::kOrm) kinds.push_back(TextureKind::kOrm);
  if (settings.packing == Packing::kMask) kinds.push_back(TextureKind::kMask);
  std::vector<TextureKind> unique;
  for (const TextureKind kind : kinds)
    if (std::ranges::find(unique, kind) == unique.end()) unique.push_back(kind);
  kinds = std::move(unique);
}

// Names that differ in case only are one file on some systems.
std::string lower_case(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

void refuse_one_name_twice(const TextureSettings& settings) {
  const auto suffix = [&](TextureKind kind) { return settings.suffixes.at(static_cast<size_t>(kind)); };
  for (size_t i = 0; i < settings.kinds.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      if (lower_case(suffix(settings.kinds[i])) == lower_case(suffix(settings.kinds[j])))
        throw SettingError(fmt::format("{{suffix}}: {} and {} are both {}, expected two names",
                                       texture_name(settings.kinds[j]), texture_name(settings.kinds[i]),
                                       suffix(settings.kinds[i])));
}

}  // namespace

bool TextureSettings::wants(TextureKind kind) const { return std::ranges::find(kinds, kind) != kinds.end(); }

bool TextureSettings::wants_terrain() const { return std::ranges::any_of(kinds, is_terrain); }

bool TextureSettings::wants_bake() const { return !std::ranges::all_of(kinds, is_terrain); }

const std::string& texture_name(TextureKind kind) { return kNames.at(static_cast<size_t>(kind)); }

std::vector<Field> texture_fields(TextureSettings& s) {
  const std::vector<std::string> unpacked(kNames.begin(), kNames.begin() + kUnpackedKinds);
  const std::vector<std::string> occlusions = {"visibility", "ao", "bounce"};
  Value albedo = numbers(s.albedo, 3, 0, 1);
  Value suffixes = texts(s.suffix_words);
  return {
      unrecorded(texture_field(
          "maps", joined_by_commas(with_horizon_azimuths(choices(s.kinds, unpacked), s.horizon_azimuths)),
          "separated by commas; default: visibility (unless packed), bent, normal. Engines mean "
          "visibility (cosine-weighted) by AO; ao is the uniform fraction; bounce is visibility with all "
          "bounces at one albedo; bounce-map has both, in R and G. Of terrain: svf (sky-view factor of "
          "horizontal ground), openness, negative-openness, horizon:N (elevations at N azimuths)")),
      unrecorded(
          texture_field("engine", choice(s.engine, {"substance", "unreal", "unity", "godot", "gltf"}),
                        "suffixes, green channel and packing as it takes them; options given too win")),
      texture_field("format", choice(s.coding.format, format_names()),
                    "PNG of 16 or 8 bits, EXR or TIFF of 32-bit floats; all linear, 0..1"),
      texture_field("dither", flag(s.coding.dither), "with png8: dither, so that means keep their fractions"),
      texture_field(
          "normal-y", normal_y_value(s.normal_y),
          "green of bent and normal grows against the image rows (up, OpenGL; default) or along them "
          "(down, DirectX)"),
      texture_field("bent-length", choice(s.bent_length, {"unit", "visibility", "ao"}),
                    "of the bent normal B: 1; such that normal . B is the visibility; or the uniform AO"),
      shown_as(texture_field("albedo", joined_by_commas(albedo), "of irradiance: one number 0..1, or R,G,B"),
               "RHO[,G,B]"),
      of_terrain(
          texture_field("azimuths", whole(s.azimuths, 1, 65536), "of svf, openness and negative-openness"),
          s),
      of_terrain(shown_as(texture_field("radius", positive(s.radius_m, 1e30),
                                        "of svf, openness and horizon: terrain beyond does not count, m; "
                                        "default: no limit"),
                          "FLOAT"),
                 s),
      of_terrain(texture_field("curvature", flag(s.curvature),
                               "of svf, openness and horizon: the curved earth and refraction (0.13 of it) "
                               "lower far terrain"),
                 s),
      texture_field("pack", choice(s.packing, {"none", "orm", "mask"}),
                    "orm: occlusion, roughness, metallic in R, G, B; mask: metallic, occlusion, detail (1), "
                    "smoothness in R, G, B, A, as Unity takes them"),
      texture_field("occlusion",
                    choice_of(
                        occlusions, [&s] { return static_cast<size_t>(s.occlusion); },
                        [&s](size_t index) { s.occlusion = static_cast<TextureKind>(index); }),
                    "the AO that --pack packs"),
      shown_as(texture_field("roughness", text(s.roughness),
                             "packed: a number 0..1, or an image of the map's size [1]"),
               "VALUE|FILE"),
      shown_as(texture_field("metallic", text(s.metallic),
                             "packed: a number 0..1, or an image of the map's size [0]"),
               "VALUE|FILE"),
      shown_as(unrecorded(texture_field("suffix", joined_by_commas(suffixes),
                                        "ends of the files' names instead of _visibility, _bent, ...")),
               "TEXTURE=SUFFIX[,...]"),
  };
}

void resolve_textures(TextureSettings& settings) {
  const EngineConventions conventions = engine_conventions(settings.engine);
  if (!settings.normal_y) settings.normal_y = conventions.normal_y;
  if (!settings.packing) settings.packing = conventions.packing;
  settings.suffixes = conventions.suffixes;
  if (settings.albedo.size() != 1 && settings.albedo.size() != 3)
    throw SettingError(fmt::format("{{albedo}}: {} numbers, expected one, or three for red, green and blue",
                                   settings.albedo.size()));
  if (settings.coding.dither && settings.coding.format != TextureFormat::kPng8)
    throw SettingError(fmt::format("{{dither}}: serves 8 bits, but {} has {}, expected {{format}} png8",
                                   texture_format_info(settings.coding.format).name,
                                   texture_format_info(settings.coding.format).bits));
  if (settings.wants(TextureKind::kHorizon) && !texture_format_info(settings.coding.format).is_float)
    throw SettingError("{maps}: horizon has a channel per azimuth, expected {format} exr or tif with it");
  resolve_suffixes(settings);
  resolve_kinds(settings);
  refuse_one_name_twice(settings);
}

std::vector<std::filesystem::path> texture_paths(const TextureSettings& settings,
                                                 const std::filesystem::path& folder,
                                                 const std::string& name) {
  std::vector<std::filesystem::path> paths;
  for (const TextureKind kind : settings.kinds)
    paths.push_back(folder / (name + settings.suffixes.at(static_cast<size_t>(kind)) +
                              texture_format_info(settings.coding.format).extension));
  return paths;
}

}  // namespace hemibake
