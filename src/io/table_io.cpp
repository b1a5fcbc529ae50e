#include "io/table_io.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <unordered_set>

#include "core/context.h"
#include "core/error.h"
#include "core/printable.h"
#include "io/input_file.h"
#include "io/json_text.h"
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

// Takes a text apart at its line ends.
class Lines {
 public:
  // Leaves out a byte-order mark.
  explicit Lines(std::string_view text) : rest_(text) {
    if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
  }
  // Returns the next line without its end, or none after the last.
  std::optional<std::string_view> next() {
    if (rest_.empty()) return std::nullopt;
    ++number_;
    const size_t end = rest_.find('\n');
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }
  size_t number() const { return number_; }  // of the last one, from 1

 private:
  std::string_view rest_;
  size_t number_ = 0;
};

// Returns the fault of the column names; empty where there is none.
std::string column_error(const std::vector<std::string>& columns) {
  std::unordered_set<std::string_view> names;
  for (size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].empty()) return fmt::format("column {} has no name", i + 1);
    if (!names.insert(columns[i]).second)
      return fmt::format("column '{}' is there twice", excerpt(columns[i]));
  }
  return "";
}

// Parses a finite number, or nothing from an empty cell. place: returns that of the cell, "FILE:LINE: …".
template <class Place>
std::optional<double> parse_cell(std::string_view cell, const Place& place) {
  if (cell.empty()) return std::nullopt;
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc{} || end != cell.data() + cell.size() || !std::isfinite(value))
    throw InputError(fmt::format("{}: \"{}\" is not usable, expected a finite number or nothing", place(),
                                 excerpt(cell, 40)));
  return value;
}

// Parses a line of cells for all columns.
std::vector<std::optional<double>> parse_row(std::string_view line, const std::vector<std::string>& columns,
                                             const std::string& place) {
  const auto count = static_cast<size_t>(std::ranges::count(line, ',')) + 1;
  if (count != columns.size())
    throw InputError(
        fmt::format("{}: has {} cells, expected {} as in the first line", place, count, columns.size()));
  std::vector<std::optional<double>> row;
  row.reserve(count);
  for (const std::string_view cell : split(line, ','))
    row.push_back(parse_cell(
        cell, [&] { return fmt::format("{}: column '{}'", place, excerpt(columns[row.size()])); }));
  return row;
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
  const std::string text = read_whole_file(path, kMaxTableBytes);
  Lines lines(text);
  const std::optional<std::string_view> header = lines.next();
  if (!header) throw InputError(fmt::format("{}: is empty, expected a line of column names", path.string()));
  auto check_size = [&, cells = size_t{0}](size_t more) mutable {
    cells += more;
    if (cells > kMaxTableCells)
      throw InputError(fmt::format("{}:{}: more than {} cells, expected fewer", path.string(), lines.number(),
                                   kMaxTableCells));
  };
  const auto columns = static_cast<size_t>(std::ranges::count(*header, ',')) + 1;
  if (columns > kMaxTableColumns)
    throw InputError(
        fmt::format("{}:1: has {} columns, expected at most {}", path.string(), columns, kMaxTableColumns));
  Table table;
  for (const std::string_view name : split(*header, ',')) table.columns.emplace_back(name);
  if (const std::string error = column_error(table.columns); !error.empty())
    throw InputError(fmt::format("{}:1: {}, expected a name of its own for each", path.string(), error));
  while (const std::optional<std::string_view> line = lines.next()) {
    throw_if_cancelled();
    check_size(table.columns.size() + 4);
    table.rows.push_back(
        parse_row(*line, table.columns, fmt::format("{}:{}", path.string(), lines.number())));
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
  const std::string text = read_whole_file(path, kMaxTableBytes);
  std::vector<double> numbers;
  Lines lines(text);
  while (const std::optional<std::string_view> next = lines.next()) {
    std::string line(next->substr(0, next->find('#')));
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c == ',' || c == '\t'; }, ' ');
    const auto place = [&] { return fmt::format("{}:{}", path.string(), lines.number()); };
    for (const std::string_view word : split(line, ' '))
      if (const auto number = parse_cell(word, place)) numbers.push_back(*number);
  }
  if (numbers.size() != count)
    throw InputError(fmt::format("{}: holds {} numbers, expected {}", path.string(), numbers.size(), count));
  return numbers;
}

nlohmann::ordered_json read_json(const fs::path& path) {
  return parse_json(read_whole_file(path, kMaxJsonBytes), path.string());
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
