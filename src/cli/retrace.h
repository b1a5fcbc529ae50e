// The links of a bake once more: light that the bake does not hold goes over them.
#pragma once

#include <filesystem>

#include "cli/bake_options.h"
#include "io/bake_file.h"
#include "transport/trace_surface.h"

namespace hemibake {

// Everything the bake was traced with. Throws InputError where the map is not there, or is another.
BakeOptions tracing_options_from(const BakeFile& file, const std::filesystem::path& bake_path);

// Traces the bake's map again with its own options, links and all: the same rows, byte for byte. Throws
// InputError where that takes more memory than the machine has.
LightTransport retrace(const BakeOptions& options);

// The same from a links file of this bake. Throws InputError where it is of another.
LightTransport visibility_from_links(const std::filesystem::path& links_path, const BakeFile& file);

}  // namespace hemibake
