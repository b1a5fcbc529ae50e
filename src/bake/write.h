// The files of a bake.
#pragma once

#include <filesystem>

#include "bake/bake.h"
#include "io/provenance.h"

namespace hemibake {

// Writes BAKE.exr, and first LINKS.h5 where `links_path` is not empty: the result then has its form factors.
// Throws InputError where a file cannot be written.
void write_results(const BakeResult& result, const Provenance& provenance,
                   const std::filesystem::path& bake_path, const std::filesystem::path& links_path);

}  // namespace hemibake
