// Settings, what a bake records of them, and what is read back: field by field.
#include "bake/settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "bake/record.h"

namespace hemibake {
namespace {

const IsGiven kAll = [](const std::string&) { return true; };

// Another value than `text` that the field takes.
std::string other_value(const Field& field, const std::string& text) {
  if (field.value.type.starts_with("TEXT:{")) {
    const std::string names = field.value.type.substr(6, field.value.type.size() - 7);
    const std::string first = names.substr(0, names.find(',')), last = names.substr(names.rfind(',') + 1);
    return text == first ? last : first;
  }
  switch (field.value.kind) {
    case Value::Kind::kFlag:
      return text == "true" ? "false" : "true";
    case Value::Kind::kText:
      return field.value.type.starts_with("FLOAT") ? "2" : "other";
    default:
      break;
  }
  for (const char* candidate : {"1", "2", "0.25", "0.5"}) {
    if (text == candidate) continue;
    try {
      field.value.set({candidate});
      return candidate;
    } catch (const InputError&) {
    }
  }
  ADD_FAILURE() << field.name << ": no other value found";
  return text;
}

// Changes every recorded field in turn, records all and reads them back into fresh settings.
template <class Settings>
void expect_every_field_comes_back(const Settings& base, std::vector<Field> (*fields_of)(Settings&),
                                   int& tested) {
  Settings counted = base;
  const size_t count = fields_of(counted).size();
  for (size_t i = 0; i < count; ++i) {
    Settings changed = base;
    const Field field = fields_of(changed)[i];
    if (field.key.empty()) continue;
    field.value.set({other_value(field, field.value.get().value_or(""))});
    const std::string value = field.value.get().value_or("");  // an alias is recorded by its first name
    if (!field.recorded()) continue;                           // has no meaning beside the others of `base`
    Provenance record;
    record_fields(fields_of(changed), record);
    Settings read;
    read_fields(record, "bake.exr", fields_of(read));
    EXPECT_EQ(fields_of(read)[i].value.get(), value) << field.name;
    Provenance again;
    record_fields(fields_of(read), again);
    EXPECT_EQ(again, record) << field.name;
    // A record without it does not pass for one with the default, but where an older version had no such
    // field.
    record.erase(field.key);
    if (field.may_be_missing)
      EXPECT_NO_THROW(read_fields(record, "bake.exr", fields_of(read))) << field.name;
    else
      EXPECT_THROW(read_fields(record, "bake.exr", fields_of(read)), InputError) << field.name;
    ++tested;
  }
}

BakeSettings settings_with(TracerKind tracer) {
  BakeSettings settings;
  MapSettings map;
  settings.tracer = tracer;
  settings.patch_kind = PatchKind::kTexels;
  settings.max_distance_m = 0.5;
  settings.converge = 0.5;
  settings.target_error = 0.5;
  resolve_defaults(map, settings, kAll);
  return settings;
}

TEST(Settings, EveryFieldThatIsChangedComesBack) {
  MapSettings map;
  map.filter.radius = 1;
  map.normals_from = NormalSource::kMap;
  map.normal_y = NormalY::kUp;
  int of_the_map = 0, of_a_bake = 0;
  expect_every_field_comes_back(map, map_fields, of_the_map);
  EXPECT_GE(of_the_map, 8);
  for (const TracerKind tracer : {TracerKind::kEmbree, TracerKind::kMarch, TracerKind::kSlice})
    expect_every_field_comes_back(settings_with(tracer), bake_fields, of_a_bake);
  EXPECT_GE(of_a_bake, 30);
}

TEST(Settings, NamesAndKeysAreThereOnce) {
  MapSettings map;
  BakeSettings bake;
  std::vector<std::string> names, keys;
  for (const auto& fields : {map_fields(map), bake_fields(bake)})
    for (const Field& field : fields) {
      names.push_back(field.name);
      if (!field.key.empty()) keys.push_back(field.key);
      EXPECT_FALSE(field.help.empty()) << field.name;
    }
  for (std::vector<std::string>* all : {&names, &keys}) {
    std::ranges::sort(*all);
    EXPECT_EQ(std::ranges::adjacent_find(*all), all->end());
  }
}

// What is recorded is checked like what is typed.
TEST(Settings, RecordsAreReadThroughTheSameChecks) {
  BakeSettings settings = settings_with(TracerKind::kSlice);
  Provenance record;
  record_fields(bake_fields(settings), record);
  const auto expect_refusal = [&](const char* key, const nlohmann::json& value, const std::string& expected) {
    Provenance bad = record;
    bad[key] = value;
    BakeSettings read;
    try {
      read_fields(bad, "bake.exr", bake_fields(read));
      ADD_FAILURE() << key << " " << value;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::StartsWith(std::string("bake.exr: attribute hemibake:") + key));
      EXPECT_THAT(error.what(), testing::HasSubstr(expected));
    }
  };
  expect_refusal("rays", 0, "a whole number from 1 to 1048576");
  expect_refusal("rays", 2.5, "a whole number");
  expect_refusal("cone_degrees", -1e9, "a number above 0, at most 180");
  expect_refusal("tracer", "cubes", "not in {embree,march,slice}");
  expect_refusal("outputs", "ao,cubes", "not in {");
  expect_refusal("seed", nlohmann::json::array({1, 2}), "a whole number");
}

TEST(Settings, DefaultsFollowFromOtherSettings) {
  const auto resolved = [](auto change) {
    MapSettings map;
    BakeSettings settings;
    change(settings);
    resolve_defaults(map, settings, [](const std::string&) { return false; });
    return settings;
  };
  const BakeSettings plain = resolved([](BakeSettings&) {});
  EXPECT_EQ(plain.tracer, TracerKind::kSlice);
  EXPECT_EQ(plain.rays, 64);
  EXPECT_EQ(plain.patch_kind, PatchKind::kFacets);
  EXPECT_EQ(resolved([](BakeSettings& s) { s.cone_degrees = 90; }).tracer, TracerKind::kEmbree);
  EXPECT_EQ(resolved([](BakeSettings& s) { s.rays = 70000; }).tracer, TracerKind::kEmbree);
  EXPECT_EQ(resolved([](BakeSettings& s) { s.directions = DirectionSet::kCosine; }).rays, 256);
  const BakeSettings preset = resolved([](BakeSettings& s) { s.preset = Preset::kMayaux2018; });
  EXPECT_EQ(preset.tracer, TracerKind::kMarch);
  EXPECT_EQ(preset.rays, 1024);
  EXPECT_EQ(preset.patch_kind, PatchKind::kTexels);
}

}  // namespace
}  // namespace hemibake
