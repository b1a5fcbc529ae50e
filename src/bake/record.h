// How a bake was made, as its files carry it, and read back from there.
#pragma once

#include <filesystem>
#include <string_view>

#include "bake/bake.h"
#include "io/bake_file.h"
#include "io/provenance.h"

namespace hemibake {

// Records everything that decides the bytes of a bake, and what was measured of it. command: what made it.
Provenance record_of(const LoadedMap& map, const BakeResult& result, std::string_view command);

// Records the files of a map and how they were read.
void record_map(const MapSettings& settings, const MapHashes& sha256, Provenance& provenance);

// Adds the recorded fields that have a meaning with the settings as they are, in the order of the table.
void record_fields(const std::vector<Field>& fields, Provenance& provenance);

// Sets every recorded field from `provenance`, through the same checks as a command line. Throws InputError
// naming `path` where a field that has a meaning is missing or its value is none.
void read_fields(const Provenance& provenance, const std::filesystem::path& path,
                 const std::vector<Field>& fields);

// Returns how the map of a bake was read; bakes of 0.2.0 and before took values for 0..1 whatever they were.
// Looks for the map where the bake found it, and beside `bake_path`. Throws InputError where it is in neither
// place or is no longer the same file.
MapSettings recorded_map_settings(const Provenance& provenance, const std::filesystem::path& bake_path);

// Returns how a bake was traced and bounced. Throws InputError where it does not say, or says what no command
// line may: a value out of its range, or settings that exclude each other.
BakeSettings recorded_bake_settings(const Provenance& provenance, const std::filesystem::path& bake_path);

}  // namespace hemibake
