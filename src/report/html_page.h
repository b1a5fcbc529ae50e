// The page of a report: the template that src/report/web/ is built into, filled with data.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>

#include "report/html_folder.h"
#include "report/html_planes.h"

namespace hemibake {

// The page without its data; empty where this build was made without Node, and so has no report.
std::string_view page_template();

// The whole page. data: what report_data gave.
std::string fill_page(std::string_view page, const nlohmann::ordered_json& data, const PackedPlanes& planes,
                      std::span<const ReportPicture> pictures);

}  // namespace hemibake
