// The planes of a run as an EXR with the channels of named_planes().
#pragma once

#include <filesystem>

#include "io/provenance.h"
#include "trade/trade_run.h"

namespace hemibake {

// At least one plane must be there; those that are not are left out, and so is what is not known.
void write_planes(const std::filesystem::path& path, const RunPlanes& planes, const Provenance& provenance);

// Throws InputError where the file is no such image of width × height.
RunPlanes read_run_planes(const std::filesystem::path& path, int width, int height);

}  // namespace hemibake
