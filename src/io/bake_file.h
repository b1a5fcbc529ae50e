// BAKE.exr: the planes of a bake as named 32-bit float channels (DESIGN.md, "Files").
#pragma once

#include <filesystem>

#include "io/provenance.h"
#include "transport/baked_planes.h"

namespace hemibake {

struct BakeFile {
  Bake bake;
  Provenance provenance;
};

// Channels `ao`, `irradiance.00`…, `total`, `residual`, `normal.X/Y/Z`, `bent.X/Y/Z`; planes that are empty
// are left out, every other is width × height. Provenance as attributes `hemibake:NAME` (io/image_io.h,
// write_image). Throws std::logic_error where a plane has another size, none is there, or a value is not
// finite (naming channel and texel); InputError where the file cannot be written.
void write_bake(const std::filesystem::path& path, const Bake& bake, const Provenance& provenance);

// Bit for bit what was written; channels of other names are passed over. Throws InputError naming the file
// where it is not a whole, readable bake, or a value in it is not finite.
BakeFile read_bake(const std::filesystem::path& path);

}  // namespace hemibake
