// The files of a bake.
#pragma once

#include <filesystem>

#include "bake/bake.h"
#include "io/output_file.h"
#include "io/provenance.h"

namespace hemibake {

// Writes BAKE.exr, and first LINKS.h5 where `links_path` is not empty, into `files`, which stays to be
// committed: the result then has its form factors. Returns the bake. Throws InputError where a file cannot be
// written.
OutputFile& add_bake_files(const BakeResult& result, const Provenance& provenance,
                           const std::filesystem::path& bake_path, const std::filesystem::path& links_path,
                           OutputSet& files);

}  // namespace hemibake
