// Writes a report as JSON: for its page, and for `report --json`.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>

#include "report/html_data.h"
#include "report/html_planes.h"

namespace hemibake {

// Returns everything on the page but the planes; null for what the folder does not have. web/data.ts has the
// types.
nlohmann::ordered_json json_from_report(const ReportFolder& folder, std::span<const ReportModel> models,
                                        const PackedPlanes& planes, const ReportData& data);

// Returns {"x", "y", "ao", "irradiance", "models": {ID: RGB}, "truth"} of each probe.
nlohmann::ordered_json json_from_probes(std::span<const ReportProbe> probes,
                                        std::span<const ReportModel> models);

// Returns {"ao", "all_bounces", "stored_bounces"} of each bin with texels: numbers of the library to compare
// plots with.
nlohmann::ordered_json json_from_totals(const Curves& curves, std::span<const BinTotals> totals);

}  // namespace hemibake
