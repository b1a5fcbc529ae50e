// Settings of textures: what is made of a bake, for which engine, and how it is written.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/field.h"
#include "io/image_io.h"
#include "surface/normals.h"

namespace hemibake {

// `--maps` names all up to kHorizon; the last two are packed. kSvf to kHorizon are of the map, not of a bake.
enum class TextureKind {
  kVisibility,
  kAo,
  kBounce,
  kBounceMap,
  kBent,
  kNormal,
  kIrradiance,
  kSvf,
  kOpenness,
  kNegativeOpenness,
  kHorizon,
  kOrm,
  kMask
};
constexpr size_t kTextureKinds = 13, kUnpackedKinds = 11;
constexpr bool is_terrain(TextureKind kind) {
  return kind >= TextureKind::kSvf && kind <= TextureKind::kHorizon;
}
enum class Engine { kSubstance, kUnreal, kUnity, kGodot, kGltf };
enum class Packing { kNone, kOrm, kMask };
// Length of the bent normal B: 1; so that normal · B = V; or α.
enum class BentLength { kUnit, kVisibility, kAo };

struct TextureSettings {
  std::optional<Engine> engine;
  std::vector<TextureKind>
      kinds;  // empty: visibility (unless it is packed), bent, normal; then with the packed
  TextureCoding coding;
  std::optional<NormalY> normal_y;                   // absent: the engine's, else up
  std::optional<Packing> packing;                    // absent: the engine's, else none
  TextureKind occlusion = TextureKind::kVisibility;  // the AO that is packed
  std::string roughness = "1", metallic = "0";       // packed: a number 0..1, or an image of the map's size
  BentLength bent_length = BentLength::kUnit;
  std::vector<double> albedo = {0.5};               // of the irradiance: one, or R, G and B
  int horizon_azimuths = 36;                        // channels of the horizon, as in "horizon:36"
  int azimuths = 128;                               // of the sky-view factor and the openness
  std::optional<double> radius_m;                   // terrain beyond does not count; absent: no limit
  bool curvature = false;                           // of the earth lowers far terrain
  std::vector<std::string> suffix_words;            // as given: "visibility=_AO"
  std::array<std::string, kTextureKinds> suffixes;  // by kind; filled in by resolve

  bool wants(TextureKind kind) const;
  bool wants_terrain() const;
  // Returns whether any texture is of a bake.
  bool wants_bake() const;
};

// "visibility", … "orm", "mask".
const std::string& texture_name(TextureKind kind);

// The fields refer to `settings`, which must outlive them.
std::vector<Field> texture_fields(TextureSettings& settings);

// Fills in what follows from the engine, the suffixes and the list of textures, and drops repeats. Throws
// SettingError for combinations that make no sense and for two textures of one name.
void resolve_textures(TextureSettings& settings);

// Returns the file of every texture, in the order of `kinds`. The settings are resolved.
// name: what their names begin with.
std::vector<std::filesystem::path> texture_paths(const TextureSettings& settings,
                                                 const std::filesystem::path& folder,
                                                 const std::string& name);

}  // namespace hemibake
