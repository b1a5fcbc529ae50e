// Curves as CSV: one line per bin,
//   bin,ao_low,ao_high,ao_mean,count,E00_mean,E00_stddev,E01_mean,E01_stddev,…
// with count 0 and empty cells after it for an empty bin; irradiance 0..π.
#pragma once

#include <filesystem>

#include "curves/curves.h"
#include "io/table_io.h"

namespace hemibake {

Table table_from_curves(const Curves& curves);

// Also takes the table of the published experiment: bin,E0,E1,…, irradiance means only, bins of equal width,
// and ignores its columns of other names. Throws InputError "FILE:LINE: …, expected …"; `path` names the file
// only.
Curves curves_from_table(const Table& table, const std::filesystem::path& path);

Curves read_curves(const std::filesystem::path& path);
void write_curves(const std::filesystem::path& path, const Curves& curves);

}  // namespace hemibake
