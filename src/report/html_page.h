// Fills the template that src/report/web/ is built into with the data of a report.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>

#include "report/html_folder.h"
#include "report/html_planes.h"

namespace hemibake {

// Returns the page without its data; empty in a build without Node, which has no report.
std::string_view page_template();

// Returns the whole page. data: of json_from_report.
std::string fill_page(std::string_view page, const nlohmann::ordered_json& data, const PackedPlanes& planes,
                      std::span<const ReportPicture> pictures);

}  // namespace hemibake
