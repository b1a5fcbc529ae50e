#include "bake/record.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/printable.h"
#include "io/geo_place.h"

namespace hemibake {
namespace {

void record_tracing(const BakeResult& result, Provenance& p) {
  p["rays_traced"] = result.counts.rays;
  p["rays_cut_short"] = result.counts.truncated;
  if (result.energy) p["links"] = result.links;
}

void record_energy(const LinkEnergy& energy, Provenance& p) {
  p["row_sum_error"] = energy.row_sum_error;
  if (!energy.light_over_opening) return;
  p["light_over_opening"] = *energy.light_over_opening;
  p["light_over_opening_stderr"] = energy.light_over_opening_stderr;
}

void record_bounces(const Bounces& bounces, Provenance& p) {
  p["bounces_made"] = bounces.bounces_made;
  p["mean_residual"] = bounces.mean_residual;
  p["worst_residual"] = bounces.worst_residual;
  p["texels_short"] = bounces.unconverged_texels.size();
  p["texels_closed"] = bounces.enclosed_texels.size();
}

void record_errors(const ErrorEstimate& errors, Provenance& p) {
  p["error_ao_rays"] = errors.ao_rays;
  p["error_direct_rays"] = errors.direct_rays;
  p["error_first_rays"] = errors.first_rays;
  p["error_mean_direct_rays"] = errors.mean_direct_rays;
  p["error_mean_first_rays"] = errors.mean_first_rays;
  p["error_mean_first_patches"] = errors.first_patches;
  p["error_mean_half_patches"] = errors.half_patches;
  p["error_mean_total_bounces"] = errors.total_bounces;
  p["error_mean_half_bounces"] = errors.half_bounces;
  p["error_far_horizon"] = errors.far_horizon;
  p["error_curve_direct_rays"] = errors.curve_direct;
  p["error_curve_first_rays"] = errors.curve_first;
}

void record_reached(const BakeSettings& settings, const TargetErrors& reached, Provenance& p) {
  p["reached_error_ao"] = reached.ao;
  p["reached_error_direct"] = reached.direct;
  for (size_t a = 0; settings.wants(BakeOutput::kIrradiance) && a < kJudgedAlbedos.size(); ++a)
    p[fmt::format("reached_error_albedo_{:g}", kJudgedAlbedos[a])] = reached.light[a];
}

nlohmann::ordered_json json_from(const Field& field, const std::string& text) {
  switch (field.value.kind) {
    case Value::Kind::kNumber:
      return std::stod(text);
    case Value::Kind::kWhole:
      return std::stoll(text);
    case Value::Kind::kUnsigned:
      return std::stoull(text);
    case Value::Kind::kFlag:
      return text == "true";
    case Value::Kind::kText:
      break;
  }
  return field.key_prefix + valid_utf8(text);
}

// Splits what commas join.
std::vector<std::string> words_of(const Value& value, const std::string& text) {
  std::vector<std::string> words{""};
  for (const char c : text)
    if (c == ',' && value.separated)
      words.emplace_back();
    else
      words.back() += c;
  return words;
}

void set_from(const Field& field, const nlohmann::ordered_json& recorded) {
  std::string text = recorded.is_string() ? recorded.get<std::string>() : recorded.dump();
  if (!text.starts_with(field.key_prefix))
    throw InputError(fmt::format("'{}', expected '{}…'", excerpt(text), field.key_prefix));
  text.erase(0, field.key_prefix.size());
  const Value& value = field.value;
  const std::vector<std::string> words = words_of(value, text);
  const auto count = static_cast<int>(words.size());
  if (value.separated && (count < value.fewest || (value.most >= 0 && count > value.most)))
    throw InputError(fmt::format("'{}', expected {} to {} values between commas", excerpt(text), value.fewest,
                                 value.most));
  value.set(words);
}

// The file `provenance[path_key]` names, if it is still the one with the hash recorded.
std::filesystem::path find_input(const Provenance& provenance, const char* path_key, const char* hash_key,
                                 const std::filesystem::path& bake_path) {
  const auto recorded_text = [&](const char* key) {
    if (!provenance.is_object() || !provenance.contains(key) || !provenance[key].is_string())
      throw InputError(bake_path.string() +
                       ": it does not say what it was made from, expected a bake of this version");
    return provenance[key].get<std::string>();
  };
  const std::filesystem::path recorded = recorded_text(path_key);
  const std::string hash = recorded_text(hash_key);
  // The second is of bakes before 0.3.0, which recorded the path as it was typed.
  const std::filesystem::path places[] = {bake_path.parent_path() / recorded, recorded,
                                          bake_path.parent_path() / recorded.filename()};
  std::filesystem::path other;
  for (const auto& place : places) {
    std::error_code not_there;
    if (!std::filesystem::is_regular_file(place, not_there)) continue;
    if (sha256_of_file(place) == hash) return place;
    if (other.empty()) other = place;
  }
  if (!other.empty())
    throw InputError(other.string() +
                     ": not the file the bake was made from, expected its SHA-256 to be the same");
  throw InputError(
      fmt::format("{}: the map of this bake is not there, expected it beside the bake or where it was",
                  recorded.string()));
}

// Returns whether a bake is of 0.2.0 or before: none of them says what map values are.
bool is_of_old_version(const Provenance& provenance) {
  return provenance.contains("texel_size_m") && !provenance.contains("heights");
}

// Makes settings what old versions did without saying so.
void read_as_before(const Provenance& provenance, const std::filesystem::path& path, MapSettings& settings) {
  for (const char* key : {"size_m", "amplitude_m"})
    if (!provenance.contains(key))
      throw InputError(
          fmt::format("{}: it does not say its {}, expected a bake of this version", path.string(), key));
  settings.heights = HeightUnit::kUnit;
  if (settings.normals_from != NormalSource::kMap) return;
  settings.normal_channels = "0,1,2";
  settings.normal_encoding = NormalEncoding::kLinear;
}

}  // namespace

Provenance record_of(const LoadedMap& map, const BakeResult& result, std::string_view command) {
  Provenance p = make_provenance(command);
  record_map(map.settings, map.sha256, p);
  if (map.place) record_place(place_without_ring(*map.place, result.settings.margin), p);
  p["texel_size_m"] = result.texel_size_m;
  BakeSettings settings = result.settings;
  record_fields(bake_fields(settings), p);
  record_tracing(result, p);
  if (result.energy) record_energy(*result.energy, p);
  if (result.bounces) record_bounces(*result.bounces, p);
  if (result.errors) record_errors(*result.errors, p);
  if (result.reached) record_reached(result.settings, *result.reached, p);
  return p;
}

void record_map(const MapSettings& settings, const MapHashes& sha256, Provenance& p) {
  MapSettings copy = settings;
  p["input"] = valid_utf8(settings.map.filename().string());
  p["input_sha256"] = sha256.map;
  p["input_path"] = valid_utf8(settings.map.string());
  record_fields(map_fields(copy), p);
  if (settings.normals_from != NormalSource::kMap) return;
  p["normals_path"] = valid_utf8(settings.normal_map.string());
  p["normals_sha256"] = sha256.normal_map;
}

void record_fields(const std::vector<Field>& fields, Provenance& provenance) {
  for (const Field& field : fields)
    if (!field.key.empty() && field.recorded())
      provenance[field.key] = json_from(field, field.value.get().value_or(""));
}

void read_fields(const Provenance& provenance, const std::filesystem::path& path,
                 const std::vector<Field>& fields) {
  for (const Field& field : fields) {
    if (field.key.empty()) continue;
    const bool is_there = provenance.is_object() && provenance.contains(field.key);
    if (!is_there && (field.may_be_missing || !field.recorded())) continue;
    if (!is_there)
      throw InputError(fmt::format("{}: it does not say its {}, expected a bake of this version",
                                   path.string(), field.key));
    try {
      set_from(field, provenance[field.key]);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: attribute hemibake:{}: {}", path.string(), field.key, error.what()));
    }
  }
}

MapSettings recorded_map_settings(const Provenance& provenance, const std::filesystem::path& bake_path) {
  MapSettings settings;
  settings.map = find_input(provenance, "input_path", "input_sha256", bake_path);
  read_fields(provenance, bake_path, map_fields(settings));
  if (settings.normals_from == NormalSource::kMap)
    settings.normal_map = find_input(provenance, "normals_path", "normals_sha256", bake_path);
  if (is_of_old_version(provenance)) read_as_before(provenance, bake_path, settings);
  return settings;
}

BakeSettings recorded_bake_settings(const Provenance& provenance, const std::filesystem::path& bake_path) {
  BakeSettings settings;
  read_fields(provenance, bake_path, bake_fields(settings));
  MapSettings map;
  read_fields(provenance, bake_path, map_fields(map));
  if (map.normals_from == NormalSource::kMap) map.normal_map = "recorded";
  resolve_defaults(map, settings, [](const std::string&) { return true; });
  try {
    validate(map, settings, [](const std::string&) { return false; });
  } catch (const SettingError& error) {
    throw InputError(
        fmt::format("{}: what it records goes not together: {}", bake_path.string(), error.what()));
  }
  return settings;
}

}  // namespace hemibake
