#include "io/table_io.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>

#include "core/error.h"
#include "io/input_file.h"
#include "io/output_file.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

// Splits into one piece more than there are separators.
std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> pieces;
  for (;;) {
    const size_t end = text.find(separator);
    pieces.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return pieces;
    text.remove_prefix(end + 1);
  }
}

// Splits at line ends; drops a byte-order mark and the empty piece after the last line end.
std::vector<std::string_view> split_lines(std::string_view text) {
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  std::vector<std::string_view> lines = split(text, '\n');
  if (lines.back().empty()) lines.pop_back();
  for (std::string_view& line : lines)
    if (line.ends_with('\r')) line.remove_suffix(1);
  return lines;
}

// Returns the fault of the column names; empty where there is none.
std::string column_error(const std::vector<std::string>& columns) {
  for (size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].empty()) return fmt::format("column {} has no name", i + 1);
    if (std::find(columns.begin(), columns.begin() + static_cast<ptrdiff_t>(i), columns[i]) !=
        columns.begin() + static_cast<ptrdiff_t>(i))
      return fmt::format("column '{}' is there twice", columns[i]);
  }
  return "";
}

// Parses a finite number, or nothing from an empty cell. place: for the error, "FILE:LINE: …".
std::optional<double> parse_cell(std::string_view cell, const std::string& place) {
  if (cell.empty()) return std::nullopt;
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc{} || end != cell.data() + cell.size() || !std::isfinite(value))
    throw InputError(fmt::format("{}: {} is not usable, expected a finite number or nothing", place,
                                 nlohmann::ordered_json(cell.substr(0, 40))
                                     .dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace)));
  return value;
}

// Throws std::logic_error with the place of a number that is not finite.
void check_finite(const nlohmann::ordered_json& json, const std::string& place) {
  if (json.is_number_float() && !std::isfinite(json.get<double>()))
    throw std::logic_error(
        fmt::format("internal check failed: {} is {}, expected a finite number", place, json.get<double>()));
  if (json.is_structured())
    for (const auto& [name, value] : json.items()) check_finite(value, place + "/" + name);
}

}  // namespace

Table read_csv(const fs::path& path) {
  const std::string text = read_whole_file(path);
  const std::vector<std::string_view> lines = split_lines(text);
  if (lines.empty())
    throw InputError(fmt::format("{}: is empty, expected a line of column names", path.string()));
  Table table;
  for (const std::string_view name : split(lines[0], ',')) table.columns.emplace_back(name);
  if (const std::string error = column_error(table.columns); !error.empty())
    throw InputError(fmt::format("{}:1: {}, expected a name of its own for each", path.string(), error));
  for (size_t i = 1; i < lines.size(); ++i) {
    const std::vector<std::string_view> cells = split(lines[i], ',');
    if (cells.size() != table.columns.size())
      throw InputError(fmt::format("{}:{}: has {} cells, expected {} as in the first line", path.string(),
                                   i + 1, cells.size(), table.columns.size()));
    auto& row = table.rows.emplace_back();
    for (size_t c = 0; c < cells.size(); ++c)
      row.push_back(
          parse_cell(cells[c], fmt::format("{}:{}: column '{}'", path.string(), i + 1, table.columns[c])));
  }
  return table;
}

void write_csv(OutputFile& file, const Table& table) {
  if (table.columns.empty()) throw std::logic_error("a table to write has no columns");
  if (const std::string error = column_error(table.columns); !error.empty())
    throw std::logic_error("a table to write: " + error);
  std::string text = fmt::format("{}\n", fmt::join(table.columns, ","));
  if (text.find_first_of("\n\r\"") != text.size() - 1 ||
      std::count(text.begin(), text.end(), ',') + 1 != static_cast<ptrdiff_t>(table.columns.size()))
    throw std::logic_error("a column name to write holds a comma, a quote or a line end");
  for (size_t i = 0; i < table.rows.size(); ++i) {
    expect_equal(table.rows[i].size(), table.columns.size(), fmt::format("cells in row {} to write", i));
    for (size_t c = 0; c < table.columns.size(); ++c) {
      const std::optional<double>& cell = table.rows[i][c];
      if (cell && !std::isfinite(*cell))
        throw std::logic_error(fmt::format("internal check failed: row {} of column '{}' to write is {}", i,
                                           table.columns[c], *cell));
      if (c > 0) text += ',';
      if (cell) fmt::format_to(std::back_inserter(text), "{}", *cell);
    }
    text += '\n';
  }
  file.write(text);
}

void write_csv(const fs::path& path, const Table& table) {
  OutputFile file(path);
  write_csv(file, table);
  file.commit();
}

std::optional<size_t> find_column(const Table& table, std::string_view name) {
  const auto found = std::find(table.columns.begin(), table.columns.end(), name);
  if (found == table.columns.end()) return std::nullopt;
  return static_cast<size_t>(found - table.columns.begin());
}

std::vector<double> read_numbers(const fs::path& path, size_t count) {
  const std::string text = read_whole_file(path);
  const std::vector<std::string_view> lines = split_lines(text);
  std::vector<double> numbers;
  for (size_t i = 0; i < lines.size(); ++i) {
    std::string line(lines[i].substr(0, lines[i].find('#')));
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c == ',' || c == '\t'; }, ' ');
    for (const std::string_view word : split(line, ' '))
      if (const auto number = parse_cell(word, fmt::format("{}:{}", path.string(), i + 1)))
        numbers.push_back(*number);
  }
  if (numbers.size() != count)
    throw InputError(fmt::format("{}: holds {} numbers, expected {}", path.string(), numbers.size(), count));
  return numbers;
}

nlohmann::ordered_json read_json(const fs::path& path) {
  const std::string text = read_whole_file(path);
  try {
    return nlohmann::ordered_json::parse(text);
  } catch (const nlohmann::ordered_json::exception& error) {
    // "[json.exception.parse_error.101] parse error at line 1, column 2: …": the position is what helps.
    const std::string_view what = error.what();
    throw InputError(fmt::format("{}: {}, expected JSON", path.string(), what.substr(what.find("] ") + 2)));
  }
}

void write_json(OutputFile& file, const nlohmann::ordered_json& json) {
  check_finite(json, file.path().filename().string());
  file.write(json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

void write_json(const fs::path& path, const nlohmann::ordered_json& json) {
  OutputFile file(path);
  write_json(file, json);
  file.commit();
}

}  // namespace hemibake
