// The form factors of a finished bake once more: light that it does not hold goes over them.
#pragma once

#include <filesystem>

#include "bake/settings.h"
#include "core/context.h"
#include "io/bake_file.h"
#include "transport/trace_surface.h"

namespace hemibake {

// Traces the map again as it was for the bake: the same rows, byte for byte. Throws InputError where that
// takes more memory than the machine has. settings: as recorded_map_settings and recorded_bake_settings.
LightTransport retrace(const MapSettings& map_settings, const BakeSettings& settings, const Context& context);

// Reads the form factors of a bake from its links file. Throws InputError where it is of another bake.
LightTransport transport_from_links(const std::filesystem::path& links_path, const BakeFile& file);

}  // namespace hemibake
