#include "textures/engines.h"

namespace hemibake {
namespace {

struct Conventions {
  NormalY normal_y;
  Packing packing;
  const char *visibility, *bent, *normal, *packed;  // suffixes
};

// In the order of Engine.
constexpr std::array kEngines = {
    Conventions{NormalY::kDown, Packing::kNone, "_ambient_occlusion", "_bent_normals_base", "_normal_base",
                "_orm"},
    Conventions{NormalY::kDown, Packing::kOrm, "_AO", "_BN", "_N", "_ORM"},
    Conventions{NormalY::kUp, Packing::kMask, "_Occlusion", "_BentNormal", "_Normal", "_MaskMap"},
    Conventions{NormalY::kUp, Packing::kOrm, "_ao", "_bent_normal", "_normal", "_orm"},
    Conventions{NormalY::kUp, Packing::kOrm, "_occlusion", "_bentNormal", "_normal",
                "_occlusionRoughnessMetallic"}};

}  // namespace

EngineConventions engine_conventions(std::optional<Engine> engine) {
  EngineConventions result;
  const auto suffix = [&](TextureKind kind) -> std::string& {
    return result.suffixes.at(static_cast<size_t>(kind));
  };
  for (size_t k = 0; k < kTextureKinds; ++k) {
    std::string& name = result.suffixes.at(k) = "_" + texture_name(static_cast<TextureKind>(k));
    std::ranges::replace(name, '-', '_');
  }
  if (!engine) return result;
  const Conventions& wanted = kEngines.at(static_cast<size_t>(*engine));
  result.normal_y = wanted.normal_y;
  result.packing = wanted.packing;
  suffix(TextureKind::kVisibility) = wanted.visibility;
  suffix(TextureKind::kAo) = "_ao_uniform";  // the engines' own "AO" is V
  suffix(TextureKind::kBent) = wanted.bent;
  suffix(TextureKind::kNormal) = wanted.normal;
  suffix(wanted.packing == Packing::kMask ? TextureKind::kMask : TextureKind::kOrm) = wanted.packed;
  return result;
}

}  // namespace hemibake
