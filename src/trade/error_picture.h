// Draws the signed error of a run, texel by texel.
#pragma once

#include <filesystem>
#include <string>

#include "io/provenance.h"
#include "trade/trade_run.h"

namespace hemibake {

// The error that is drawn in full colour; larger ones look the same.
inline constexpr double kErrorPictureScale = 0.1;

// FOLDER/ID-PLANE.png of α, E₀/π and E/π at albedo 0.5, those that the run has: blue where it is too dark,
// red where too bright, white where right, grey where it has no answer.
void write_error_pictures(const std::filesystem::path& folder, const std::string& id, const RunPlanes& planes,
                          const RunPlanes& truth, const Provenance& provenance);

}  // namespace hemibake
