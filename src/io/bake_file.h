// BAKE.exr: the planes of a bake as named 32-bit float channels. src/io/README.md describes the file.
#pragma once

#include <filesystem>

#include "io/provenance.h"
#include "transport/baked_planes.h"

namespace hemibake {

struct BakeFile {
  Bake bake;
  Provenance provenance;
};

// Writes `ao`, `irradiance.00`…, `total`, `residual`, `normal.X/Y/Z`, `bent.X/Y/Z`, and the provenance as
// attributes `hemibake:NAME` (write_image). A .tif has the same planes as bands, with the map's place. Leaves
// out planes that are empty. Throws std::logic_error where a plane has another size, all are empty, or a
// value is not finite, but for holes that the provenance says are open; InputError where the file cannot be
// written.
void write_bake(const std::filesystem::path& path, const Bake& bake, const Provenance& provenance);

// Reads bit for bit the planes written; ignores channels of other names. Throws InputError naming the file
// where it is not a whole, readable bake, or a value in it is not finite or out of its range, but for
// rounding: ao, visibility, bounce 0..1, irradiance and total 0..π, residual −1..1, vectors of length 1 (bent
// also 0). Bakes that record published weights, stored normal lengths or a cone may hold more light. NaN in
// every plane is a hole where the provenance says that holes are open.
BakeFile read_bake(const std::filesystem::path& path);

}  // namespace hemibake
