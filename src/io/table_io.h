// Tables of numbers as CSV, and JSON documents, in every locale alike.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/output_file.h"

namespace hemibake {

constexpr size_t kMaxTableBytes = size_t{256} << 20;
constexpr size_t kMaxTableColumns = size_t{1} << 16;
constexpr size_t kMaxTableCells = size_t{1} << 24;  // of read_csv; a line counts as four more

// Columns by name; a missing cell is empty.
struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<std::optional<double>>> rows;  // each as long as `columns`
};

// Reads one header line of names, then one line of numbers per row, separated by commas; an empty cell is
// missing. Takes LF and CRLF line ends, a last line without one, and a byte-order mark. Throws InputError
// naming file, line and column for a name that is empty or repeated, a row of another length, a cell that is
// not a finite number, and more than kMaxTableBytes, kMaxTableColumns or
// kMaxTableCells.
Table read_csv(const std::filesystem::path& path);

// Writes numbers in the shortest form that reads back exactly. Throws std::logic_error for a table that
// read_csv would refuse; InputError where the file cannot be written.
void write_csv(OutputFile& file, const Table& table);
void write_csv(const std::filesystem::path& path, const Table& table);

// Returns the index of the column, if it is there.
std::optional<size_t> find_column(const Table& table, std::string_view name);

// Reads finite numbers separated by spaces, commas or line ends; # begins a comment. Throws InputError naming
// file and line for anything else, and where there are not `count` of them.
std::vector<double> read_numbers(const std::filesystem::path& path, size_t count);

// Reads JSON with its names in their order. Throws InputError as parse_json (json_text.h).
nlohmann::ordered_json read_json(const std::filesystem::path& path);

// Writes with an indent of two spaces and a final line end. Throws std::logic_error naming a number that is
// not finite; InputError where the file cannot be written.
void write_json(OutputFile& file, const nlohmann::ordered_json& json);
void write_json(const std::filesystem::path& path, const nlohmann::ordered_json& json);

}  // namespace hemibake
