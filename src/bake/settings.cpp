#include "bake/settings.h"

#include <fmt/format.h>

#include <algorithm>

namespace hemibake {
namespace {

constexpr int kMaxRays = 1 << 20;
constexpr int kMaxStoredBounces = 1000;
constexpr int kMaxBounces = 1000000;
constexpr int kMaxSteps = 10000000;
constexpr double kLargestLengthM = 1e9, kSmallestTexelM = 1e-12;

// A field that is on the command line only.
Field unrecorded(std::string name, std::string group, Value value, std::string help) {
  Field field;
  field.name = std::move(name);
  field.group = std::move(group);
  field.help = std::move(help);
  field.value = std::move(value);
  return field;
}

Field recorded(std::string name, std::string key, std::string group, Value value, std::string help) {
  Field field = unrecorded(std::move(name), std::move(group), std::move(value), std::move(help));
  field.key = std::move(key);
  return field;
}

Field shown_as(Field field, std::string placeholder) {
  field.placeholder = std::move(placeholder);
  return field;
}

Field when(std::function<bool()> has_meaning, Field field) {
  field.recorded = std::move(has_meaning);
  return field;
}

// Marks a field that bakes of older versions, or with other settings, do not record.
Field with_default(Field field) {
  field.may_be_missing = true;
  return field;
}

// Returns the fields of what is beyond the border and what the file holds.
std::vector<Field> file_fields(MapSettings& s) {
  return {
      recorded("edge", "edge", "Surface", choice(s.edge, {"wrap", "open", "ground"}),
               "beyond the border: the map again for ever (wrap), nothing (open), or ground level with the "
               "border (ground)"),
      recorded("channel", "channel", "", text(s.file.channel),
               "channel of the map to take, by name or index; default: green, or the only one"),
      when(
          [&s] { return s.file.encoding != SplitEncoding::kNone; },
          recorded(
              "encoding", "encoding", "Map", choice(s.file.encoding, {"none", "terrarium", "mapbox", "rg16"}),
              "heights split over channels of 8 bits: map tiles of Terrarium or Mapbox, or upper bits in "
              "red and lower in green [none]")),
      when([&s] { return s.file.part.has_value(); },
           recorded("part", "part", "Map", whole(s.file.part, 0, 65535),
                    "of a file of several images, from 0")),
      when([&s] { return s.file.window != ImageWindow::kDisplay; },
           recorded("window", "window", "Map", choice(s.file.window, {"display", "data"}),
                    "of an EXR: the one that is shown, or the one that has data [display]")),
      when([&s] { return !s.file.raw.empty(); },
           shown_as(recorded("raw", "raw", "Map", text(s.file.raw),
                             "size and type of a file without a header: u8, i8, u16le, u16be, i16le, i16be, "
                             "f32le, f32be, f64le, f64be"),
                    "WxH:TYPE")),
      when([&s] { return s.file.no_data.has_value(); },
           recorded("nodata", "nodata", "Map", number(s.file.no_data, -1e300, 1e300),
                    "stored value of texels without a height; default: as the file says")),
      when([&s] { return s.holes != Holes::kRefuse; },
           recorded("holes", "holes", "Map", choice(s.holes, {"refuse", "fill", "open"}),
                    "texels without a height: refused (default), filled smoothly from their rim, or open: no "
                    "surface, sky is seen through them (with --tracer embree)")),
  };
}

// Returns the fields of lengths and heights in metres.
std::vector<Field> unit_fields(MapSettings& s) {
  Value texel = numbers(s.texel_m, 2, kSmallestTexelM, kLargestLengthM);
  texel.fewest = 1;
  return {
      with_default(when([&s] { return s.size_m.has_value(); },
                        recorded("size", "size_m", "Surface", positive(s.size_m, kLargestLengthM),
                                 "length of the map's longer side, m; default: 1, or as the file says"))),
      with_default(when(
          [&s] { return !s.texel_m.empty(); },
          shown_as(recorded("texel", "texel_m", "Surface", texel,
                            "width of a texel, and its height where that is another, m, instead of --size"),
                   "X[,Y]"))),
      with_default(
          when([&s] { return s.amplitude_m.has_value(); },
               recorded("amplitude", "amplitude_m", "Surface", number(s.amplitude_m, 0, kLargestLengthM),
                        "height of map value 1 over 0, m; default: 0.1"))),
      with_default(
          when([&s] { return s.low_m.has_value(); },
               recorded("low", "low_m", "Surface", number(s.low_m, -kLargestLengthM / 2, kLargestLengthM / 2),
                        "height of map value 0 (black), m, with --high; default: 0"))),
      with_default(when(
          [&s] { return s.high_m.has_value(); },
          recorded("high", "high_m", "Surface", number(s.high_m, -kLargestLengthM / 2, kLargestLengthM / 2),
                   "height of map value 1 (white), m, instead of --amplitude; may be the lower one"))),
      with_default(when(
          [&s] { return s.heights.has_value(); },
          recorded("heights", "heights", "Surface", choice(s.heights, {"metres", "unit"}),
                   "map values: metres as stored, or 0..1 (integers over their range); default: metres for "
                   "terrain, signed integers and floats that range over more than 2, else unit"))),
  };
}

std::vector<Field> filter_fields(MapSettings& s) {
  const auto filtered = [&s] { return s.filter.radius > 0; };
  return {
      recorded("filter-radius", "filter_radius", "March", number(s.filter.radius, 0, 16),
               "bilateral filter of the heights first, texels; 0: none [1]"),
      when(filtered, recorded("filter-tolerance", "filter_tolerance", "March",
                              positive(s.filter.tolerance, 1e6), "its range, in map values 0..1 [0.2]")),
      when(filtered, recorded("filter-sum", "filter_sum", "March", choice(s.filter.sum, {"all", "published"}),
                              "its whole kernel, or the part the published shader adds up [published]")),
  };
}

std::vector<Field> normal_fields(MapSettings& s) {
  const auto has_normal_map = [&s] { return s.normals_from == NormalSource::kMap; };
  Field normals =
      recorded("normals-from", "normals", "Surface", choice(s.normals_from, {"heights", "faces", "map"}),
               "without a normal map: central differences of the heights, or angle-weighted faces");
  normals.key_prefix = "from ";
  normals.value.type = "TEXT:{heights,faces}";  // a map is said by its file
  return {
      normals,
      shown_as(unrecorded("normals", "Surface", file(s.normal_map),
                          "normal map of the same size; needs --normal-y, but for normals of a bake"),
               "FILE"),
      with_default(when(
          [&s, has_normal_map] { return has_normal_map() && (s.normal_y || s.decide_normal_y); },
          recorded("normal-y", "normal_y", "Surface", normal_y_value(s.normal_y, &s.decide_normal_y),
                   "green of the normal map grows against the image rows (up, OpenGL), along them (down, "
                   "DirectX), or as fits the heights (auto)"))),
      with_default(when(
          [&s, has_normal_map] { return has_normal_map() && !s.normal_channels.empty(); },
          shown_as(recorded("normal-channels", "normal_channels", "Surface", text(s.normal_channels),
                            "channels of the normal map, by name or index, a minus before one that is stored "
                            "negated; z may be left out; default: the first three"),
                   "X,Y[,Z]"))),
      with_default(when(
          [&s, has_normal_map] { return has_normal_map() && s.normal_encoding; },
          recorded("normal-encoding", "normal_encoding", "Surface",
                   choice(s.normal_encoding, {"linear", "signed", "srgb"}),
                   "of the normal map's numbers: 0..1, -1..1, or 0..1 by the curve of sRGB; default: signed "
                   "for floats that prove it, else linear"))),
  };
}

}  // namespace

Value normal_y_value(std::optional<NormalY>& variable, bool* decide) {
  // Up and down in turn; "auto" last, and only with `decide`.
  std::vector<std::string> names = {"up", "down", "opengl", "directx", "gl", "dx"};
  const size_t kAuto = names.size();
  if (decide != nullptr) names.emplace_back("auto");
  return choice_of(
      std::move(names),
      [&variable, decide, kAuto]() -> std::optional<size_t> {
        if (variable) return static_cast<size_t>(*variable);
        return decide != nullptr && *decide ? std::optional(kAuto) : std::nullopt;
      },
      [&variable, decide, kAuto](size_t index) {
        if (decide != nullptr) *decide = index == kAuto;
        variable.reset();
        if (index != kAuto) variable = static_cast<NormalY>(index % 2);
      });
}

bool BakeSettings::wants(BakeOutput output) const {
  return std::ranges::find(outputs, output) != outputs.end();
}

bool BakeSettings::needs_form_factors() const {
  return trace_form_factors || (wants(BakeOutput::kIrradiance) && (bounces > 0 || converge));
}

bool BakeSettings::makes_bounce_plane() const {
  return bounce_albedo && wants(BakeOutput::kIrradiance) && (trace_form_factors || bounces > 1 || converge);
}

KeptLinks BakeSettings::kept_links() const {
  if (!needs_form_factors()) return KeptLinks::kNone;
  const bool one_bounce =
      bounces <= 1 && !converge && !target_error && !trace_form_factors && !keep_transport;
  return one_bounce ? KeptLinks::kOfTexels : KeptLinks::kAll;
}

std::vector<Field> map_fields(MapSettings& s) {
  std::vector<Field> fields = {
      unrecorded("MAP", "", file(s.map), "height map: PNG, TIFF, EXR or anything else OpenImageIO reads")};
  fields[0].required = true;
  for (const std::vector<Field>& more : {unit_fields(s), file_fields(s), filter_fields(s), normal_fields(s)})
    fields.insert(fields.end(), more.begin(), more.end());
  return fields;
}

// In the order of the record; the help sorts by group.
// NOLINTNEXTLINE(readability-function-size): one list
std::vector<Field> bake_fields(BakeSettings& s) {
  const auto marches = [&s] { return s.tracer == TracerKind::kMarch; };
  const auto shoots_rays = [&s] { return s.tracer == TracerKind::kEmbree; };
  const auto links_texels = [&s] {
    return s.tracer != TracerKind::kMarch && s.patch_kind == PatchKind::kTexels;
  };
  const auto is_limited = [&s] { return s.max_distance_m.has_value(); };
  const auto converges = [&s] { return s.converge.has_value(); };
  const auto has_margin = [&s] { return s.margin > 0; };
  const auto has_target = [&s] { return s.target_error.has_value(); };
  return {
      recorded("tracer", "tracer", "Tracing", choice(s.tracer, {"embree", "march", "slice"}),
               "how visibility is found: vertical slices (default), rays with Embree (default with --cone, "
               "--directions, over 65536 --rays or open holes, which slices do not have), or the texel march "
               "of 2018"),
      recorded("rays", "rays", "Tracing", whole(s.rays, 1, kMaxRays),
               "azimuths of slices per texel (default 64), or rays per texel and per patch (default 256)"),
      recorded("cone", "cone_degrees", "Tracing", positive(s.cone_degrees, 180),
               "full aperture of the texels' rays about the normal, degrees"),
      when(is_limited, recorded("max-distance", "max_distance_m", "Tracing", positive(s.max_distance_m, 1e30),
                                "hits further along the ray count as sky, m; default: no limit")),
      unrecorded("explain", "Tracing", flag(s.explain),
                 "with --target-error: say how rays and bounces were chosen"),
      recorded("seed", "seed", "Tracing", whole(s.seed, 0), "another number, other random rotations"),

      recorded("patches", "patches", "Light", choice(s.patch_kind, {"facets", "texels"}),
               "what re-emits light: the surface's triangles (default), or the texels (as published in 2018; "
               "the only ones of march)"),
      unrecorded("preset", "March", choice(s.preset, {"published"}),
                 "published: the experiment of 2018, all options of this group and --tracer march --rays "
                 "1024 --cone 179 --normal-y up; any of them given too wins"),
      when(marches, recorded("max-steps", "max_steps", "March", whole(s.max_steps, 1, kMaxSteps),
                             "steps of a texel after which a march is sky [published: 200]")),
      when(marches, recorded("lift", "lift_percent", "March", number(s.lift_percent, 0, 100),
                             "height of a march's start over its texel, percent of the amplitude [1]")),
      when(marches, recorded("ray-set", "ray_set", "March", choice(s.ray_set, {"rotated", "published"}),
                             "turned per texel, or one set for all as published [published]")),
      when(marches,
           recorded("lookup", "lookup", "March", choice(s.lookup, {"bilinear", "published"}),
                    "heights between texels: bilinear, or as the published sampler did [published]")),
      when(marches, recorded("normalize", "normalize", "March", choice(s.weights, {"exact", "published"}),
                             "weights that sum to 1, or 2 cos/N as published [published]")),
      when(marches,
           recorded("normal-length", "normal_length", "March", choice(s.normal_length, {"unit", "stored"}),
                    "rays follow unit normals, or the map's as stored [stored]")),

      when(shoots_rays,
           recorded("directions", "directions", "Tracing", choice(s.directions, {"uniform", "cosine"}),
                    "spread of the texels' rays: equal solid angles (default), or equal shares of "
                    "irradiance")),
      when(links_texels,
           recorded("texel-links", "texel_links", "Light", choice(s.texel_links, {"nearest", "bilinear"}),
                    "with --patches texels: a hit links to the nearest texel or to four")),
      recorded("outputs", "outputs", "Output", choices(s.outputs, {"ao", "irradiance", "bent", "normal"}),
               "planes to write, separated by commas; links are traced only for irradiance with bounces, or "
               "--links"),
      recorded("bounces", "bounces", "Light", whole(s.bounces, 0, kMaxStoredBounces),
               "bounces stored one by one"),
      when(converges,
           recorded("converge", "converge", "Light", number(s.converge, 1e-12, 1),
                    "go on, into the total only, until less than this share of pi is under way in the worst "
                    "texel")),
      when(converges, recorded("max-bounces", "max_bounces", "Light", whole(s.max_bounces, 1, kMaxBounces),
                               "where --converge gives up")),

      when(has_margin, recorded("margin", "margin", "Surface", whole(s.margin, 0, 1 << 27),
                                "ring of the map that only occludes: texels cropped off every side of the "
                                "output; with --edge open or ground [0]")),
      with_default(
          when([&s] { return s.makes_bounce_plane(); },
               recorded("bounce-albedo", "bounce_albedo", "Light", number(s.bounce_albedo, 0.5, 0.99),
                        "albedo of the plane 'bounce': all light at this albedo, the second texture of "
                        "the bounce map; made with two bounces or more, or --links"))),

      when(has_target,
           recorded("target-error", "target_error", "Tracing", number(s.target_error, 1e-4, 0.5),
                    "choose rays and bounces so that the rms errors of AO, E0/pi and E/pi (albedo 0.2 to "
                    "0.95) stay below this; a sample of texels is traced first, and another afterwards says "
                    "what was reached")),
      unrecorded("memory", "Output", positive(s.memory_gib, 1e6),
                 "links that need more go to a temporary file beside the output, a bake that still does is "
                 "refused, GiB; default: what the machine has"),
  };
}

}  // namespace hemibake
