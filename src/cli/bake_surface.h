// The map of a bake as a surface, and a tracer on it.
#pragma once

#include <memory>

#include "cli/bake_options.h"
#include "io/provenance.h"
#include "surface/surface.h"
#include "tracers/tracer.h"

namespace hemibake {

struct BakeMap {
  Surface surface;
  double lowest_m = 0;         // what the surface's height 0 stands for
  Grid<float> normal_lengths;  // as the normal map stores them; empty unless asked for
};

// Reads, filters, scales; normals as the options say. Throws InputError naming the file.
BakeMap load_bake_map(const BakeOptions& options);

// `map` must outlive the tracer.
std::unique_ptr<Tracer> make_tracer(const BakeOptions& options, const BakeMap& map);

// Bytes that tracer will take.
size_t tracer_bytes(const BakeOptions& options, const Surface& surface);

// What load_bake_map needs, as the provenance of a bake holds it. The map is looked for where the bake was told to find
// it, and beside `bake_path`. Throws InputError where it is in neither place or is no longer the same file.
BakeOptions map_options_from(const Provenance& provenance, const std::filesystem::path& bake_path);

// The entries map_options_from reads.
void record_map_options(const BakeOptions& options, Provenance& provenance);

}  // namespace hemibake
