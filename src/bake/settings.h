// Settings of a bake: the map it is made of, and how its light is traced and bounced.
//
// Every setting is described once, by a field of map_fields or bake_fields. From these come the options of
// the command line with their help, what a bake records of how it was made, and what is read back of it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/field.h"
#include "io/height_file.h"
#include "surface/filter.h"
#include "surface/normals.h"
#include "surface/surface.h"
#include "tracers/march/march.h"
#include "tracers/ray_options.h"
#include "transport/trace_surface.h"

namespace hemibake {

// Source of the texels' normals: central differences of the heights, angle-weighted faces, or a file.
enum class NormalSource { kHeights, kFaces, kMap };

// Values of a height map: metres, or 0..1 (integers over their range) times the amplitude.
enum class HeightUnit { kMetres, kUnit };

// Texels without a height: refused, filled from their rim (surface/holes.h), or no surface.
enum class Holes { kRefuse, kFill, kOpen };

// Rays of a march follow unit normals, or the normal map's as long as they are stored.
enum class NormalLength { kUnit, kStored };

// Names of the enumerators of NormalY, and what other programs call them. decide: also "auto", which sets it.
Value normal_y_value(std::optional<NormalY>& variable, bool* decide = nullptr);

struct MapSettings {
  std::filesystem::path map;
  HeightFileOptions file;
  Holes holes = Holes::kRefuse;
  std::optional<HeightUnit> heights;    // absent: as the file is
  std::optional<double> size_m;         // the longer side; absent: 1, or what the texels say
  std::vector<double> texel_m;          // width, and height where it is another; empty: from the size
  std::optional<double> amplitude_m;    // height of map value 1 over 0; absent: 0.1
  std::optional<double> low_m, high_m;  // heights of map values 0 and 1, instead of an amplitude
  Edge edge = Edge::kWrap;
  FilterOptions filter{.radius = 0};
  NormalSource normals_from = NormalSource::kHeights;
  std::filesystem::path normal_map;
  std::optional<NormalY> normal_y;  // absent: as the file says, or decided by the heights
  bool decide_normal_y = false;     // by the heights
  std::string normal_channels;      // X,Y[,Z] by name or index, a minus before what is stored negated
  std::optional<NormalEncoding> normal_encoding;  // absent: told from the values
};

enum class TracerKind { kEmbree, kMarch, kSlice };
enum class BakeOutput { kAo, kIrradiance, kBent, kNormal };
enum class Preset { kMayaux2018 };

struct BakeSettings {
  std::optional<Preset> preset;
  std::optional<TracerKind> tracer;        // absent: slice, or embree where another setting asks for rays
  std::optional<int> rays;                 // absent: what serves most maps
  double cone_degrees = 180;               // (0, 180]
  std::optional<DirectionSet> directions;  // absent: uniform
  std::optional<double> max_distance_m;    // absent: no limit
  std::optional<double> target_error;      // chooses rays and bounces
  bool explain = false;
  uint64_t seed = 0;
  int margin = 0;  // texels off every side of the planes: the ring only occludes
  // For the march only.
  int max_steps = 200;
  double lift_percent = 1;
  MarchRays ray_set = MarchRays::kRotated;
  MarchLookup lookup = MarchLookup::kBilinear;
  MarchWeights weights = MarchWeights::kExact;
  NormalLength normal_length = NormalLength::kUnit;

  std::optional<PatchKind> patch_kind;  // absent: what the tracer has; facets, where it has both
  TexelLinks texel_links = TexelLinks::kBilinear;
  int bounces = 20;                // stored one by one
  std::optional<double> converge;  // largest residual of a texel, over π
  int max_bounces = 2000;
  std::optional<double> bounce_albedo = 0.9;  // of the plane `bounce`; absent: not made

  std::vector<BakeOutput> outputs = {BakeOutput::kAo, BakeOutput::kIrradiance, BakeOutput::kBent,
                                     BakeOutput::kNormal};
  std::optional<double> memory_gib;  // absent: what the machine has

  // Not on the command line.
  bool tracer_is_default = false, rays_are_default = false;  // set by resolve_defaults
  bool trace_form_factors = false;                           // although no bounce needs them
  bool keep_transport = false;                               // in the result
  bool limit_memory = true;            // plan first, spill or refuse what does not fit; false: just go
  bool estimate_errors = true;         // where there are form factors and a bounce
  std::filesystem::path spill_folder;  // empty: the current one

  bool wants(BakeOutput output) const;
  // Returns whether form factors are traced: for bounces, or because they are asked for.
  bool needs_form_factors() const;
  // Returns whether the plane `bounce` is made.
  bool makes_bounce_plane() const;
  // Returns what is traced: the links of patches for two bounces or more only.
  KeptLinks kept_links() const;
};

// The fields refer to `settings`, which must outlive them.
std::vector<Field> map_fields(MapSettings& settings);
std::vector<Field> bake_fields(BakeSettings& settings);

// Returns whether the user set a field of this name.
using IsGiven = std::function<bool(const std::string& name)>;

// Fills in what follows from other settings: the preset (where its settings are not given), the tracer, its
// rays, directions and patches.
void resolve_defaults(MapSettings& map, BakeSettings& settings, const IsGiven& given);

// Lets rays trace a surface with holes, which no other tracer knows, where the user chose none. Throws
// SettingError where the settings need one without holes. settings: resolved.
void resolve_for_holes(const Surface& surface, BakeSettings& settings);

// Throws SettingError (core/error.h) for combinations that make no sense. The settings are resolved.
void validate(const MapSettings& map, const BakeSettings& settings, const IsGiven& given);

}  // namespace hemibake
