// Tables of numbers as CSV, and JSON documents. No locale has any effect.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hemibake {

// Columns by name; a missing cell is empty.
struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<std::optional<double>>> rows;  // each as long as `columns`
};

// One header line of names, then one line of numbers per row, separated by commas; an empty cell is missing.
// Takes LF and CRLF line ends, a last line without one, and a byte-order mark. Throws InputError naming file,
// line and column for a name that is empty or there twice, a row of another length, and a cell that is not a
// finite number.
Table read_csv(const std::filesystem::path& path);

// Numbers in the shortest form that reads back exactly. Throws std::logic_error for a table that read_csv
// would not read back; InputError where the file cannot be written.
void write_csv(const std::filesystem::path& path, const Table& table);

// Index of the column, if it is there.
std::optional<size_t> find_column(const Table& table, std::string_view name);

// Finite numbers separated by spaces, commas or line ends; a # makes the rest of its line a comment. Throws
// InputError naming file and line for anything else, and where there are not `count` of them.
std::vector<double> read_numbers(const std::filesystem::path& path, size_t count);

// Throws InputError naming file and position for what is not JSON. Names keep their order.
nlohmann::ordered_json read_json(const std::filesystem::path& path);

// Indented by two spaces, with a final line end. Throws std::logic_error naming the value where a number is
// not finite, which JSON cannot hold; InputError where the file cannot be written.
void write_json(const std::filesystem::path& path, const nlohmann::ordered_json& json);

}  // namespace hemibake
