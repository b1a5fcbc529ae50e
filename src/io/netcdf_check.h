// Finds netCDF files that are cut short: their library reads zeros beyond the end.
#pragma once

#include <filesystem>
#include <string>

namespace hemibake {

// Returns what is wrong with a file in one of the classic forms of netCDF (CDF-1, 2 and 5); empty: nothing,
// or another form. Only variables without records are looked at.
std::string netcdf_error(const std::filesystem::path& path);

}  // namespace hemibake
