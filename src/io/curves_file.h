// CURVES.csv: one line per bin. src/io/README.md describes the file.
#pragma once

#include <filesystem>

#include "curves/curves.h"
#include "io/table_io.h"

namespace hemibake {

Table table_from_curves(const Curves& curves);

// Reads curves over α or V from a table of write_curves, or from that of Mayaux 2018: bin,E0,E1,…, means
// only, bins of equal width; ignores other columns. Throws InputError "FILE:LINE: …, expected …". path: for
// errors only.
Curves curves_from_table(const Table& table, const std::filesystem::path& path);

Curves read_curves(const std::filesystem::path& path);
void write_curves(OutputFile& file, const Curves& curves);
void write_curves(const std::filesystem::path& path, const Curves& curves);

}  // namespace hemibake
