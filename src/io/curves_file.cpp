#include "io/curves_file.h"

#include <fmt/format.h>

#include <cmath>
#include <unordered_map>

#include "core/error.h"

namespace hemibake {
namespace {

constexpr double kEqualEdges = 1e-9;  // edges are written in full: forgives rounding by a spreadsheet

// Cells of one table by name; errors name file and line.
class CellReader {
 public:
  CellReader(const Table& table, std::string path) : table_(table), path_(std::move(path)) {
    for (size_t i = 0; i < table.columns.size(); ++i) columns_.emplace(table.columns[i], i);
  }

  bool has_column(const std::string& name) const { return columns_.contains(name); }

  // Returns the cell; fails where it is missing or outside lowest..highest.
  double number(size_t row, const std::string& column, double lowest, double highest = HUGE_VAL) const {
    const auto index = columns_.find(column);
    if (index == columns_.end())
      throw InputError(fmt::format("{}: no column {}, expected one", path_, column));
    const std::optional<double> cell = table_.rows[row][index->second];
    if (!cell) fail(row, fmt::format("{} is empty, expected a number", column));
    if (*cell < lowest || *cell > highest) {
      fail(row, std::isfinite(highest)
                    ? fmt::format("{} is {}, expected {} to {}", column, *cell, lowest, highest)
                    : fmt::format("{} is {}, expected a number from {}", column, *cell, lowest));
    }
    return *cell;
  }

  [[noreturn]] void fail(size_t row, const std::string& fault) const {
    throw InputError(fmt::format("{}:{}: {}", path_, row + 2, fault));
  }

 private:
  const Table& table_;
  std::string path_;
  std::unordered_map<std::string, size_t> columns_;
};

std::string mean_column(int bounce) { return fmt::format("E{:02}_mean", bounce); }
std::string stddev_column(int bounce) { return fmt::format("E{:02}_stddev", bounce); }
std::string published_column(int bounce) { return fmt::format("E{}", bounce); }

void check_bin_number(const CellReader& cells, size_t row) {
  if (const double bin = cells.number(row, "bin", 0); bin != static_cast<double>(row)) {
    cells.fail(row, fmt::format("bin is {}, expected {}", bin, row));
  }
}

// low: where the bin before ends.
CurveBin read_bin(const CellReader& cells, size_t row, const Curves& curves, double low) {
  check_bin_number(cells, row);
  const std::string index = to_string(curves.index);
  CurveBin bin;
  bin.low = cells.number(row, index + "_low", 0, 1);
  bin.high = cells.number(row, index + "_high", 0, 1);
  if (std::abs(bin.low - low) > kEqualEdges)
    cells.fail(row, fmt::format("{}_low is {}, expected {} where the bin before ends", index, bin.low, low));
  if (bin.high <= bin.low)
    cells.fail(row, fmt::format("{0}_high is {1}, expected more than {0}_low {2}", index, bin.high, bin.low));
  bin.count = cells.number(row, "count", 0);
  if (bin.count != std::floor(bin.count)) {
    cells.fail(row, fmt::format("count is {}, expected a whole number", bin.count));
  }
  bin.bounces.resize(static_cast<size_t>(curves.bounce_count));
  if (bin.count == 0) return bin;
  bin.mean = cells.number(row, index + "_mean", 0, 1);
  for (int b = 0; b < curves.bounce_count; ++b) {
    bin.bounces[static_cast<size_t>(b)] = {cells.number(row, mean_column(b), 0),
                                           cells.number(row, stddev_column(b), 0)};
  }
  return bin;
}

CurveBin read_published_bin(const CellReader& cells, size_t row, size_t rows, int bounces) {
  check_bin_number(cells, row);
  CurveBin bin;
  bin.low = static_cast<double>(row) / static_cast<double>(rows);
  bin.high = static_cast<double>(row + 1) / static_cast<double>(rows);
  bin.mean = bin_center(bin);
  bin.count = 1;
  for (int b = 0; b < bounces; ++b) bin.bounces.push_back({cells.number(row, published_column(b), 0), 0});
  return bin;
}

int count_bounces(const CellReader& cells, std::string (*column)(int)) {
  int bounces = 0;
  while (cells.has_column(column(bounces))) ++bounces;
  return bounces;
}

}  // namespace

Table table_from_curves(const Curves& curves) {
  Table table;
  const std::string index = to_string(curves.index);
  table.columns = {"bin", index + "_low", index + "_high", index + "_mean", "count"};
  for (int b = 0; b < curves.bounce_count; ++b) {
    table.columns.push_back(mean_column(b));
    table.columns.push_back(stddev_column(b));
  }
  for (const CurveBin& bin : curves.bins) {
    auto& row = table.rows.emplace_back();
    row = {static_cast<double>(table.rows.size() - 1), bin.low, bin.high, std::nullopt, bin.count};
    row.resize(table.columns.size());
    if (bin.count == 0) continue;
    row[3] = bin.mean;
    for (size_t b = 0; b < bin.bounces.size(); ++b) {
      row[5 + 2 * b] = bin.bounces[b].mean;
      row[6 + 2 * b] = bin.bounces[b].stddev;
    }
  }
  return table;
}

Curves curves_from_table(const Table& table, const std::filesystem::path& path) {
  const CellReader cells(table, path.string());
  Curves curves;
  curves.has_counts = cells.has_column("count");
  if (cells.has_column("visibility_low")) curves.index = CurveIndex::kVisibility;
  curves.bounce_count = count_bounces(cells, curves.has_counts ? mean_column : published_column);
  if (curves.bounce_count == 0) {
    throw InputError(fmt::format("{}: no column {}, expected curves as 'hemibake curves' writes them",
                                 path.string(), curves.has_counts ? mean_column(0) : "count"));
  }
  if (table.rows.empty())
    throw InputError(fmt::format("{}: no bins, expected a line for each", path.string()));
  for (size_t row = 0; row < table.rows.size(); ++row) {
    const double low = row == 0 ? 0 : curves.bins.back().high;
    curves.bins.push_back(curves.has_counts
                              ? read_bin(cells, row, curves, low)
                              : read_published_bin(cells, row, table.rows.size(), curves.bounce_count));
  }
  return curves;
}

Curves read_curves(const std::filesystem::path& path) { return curves_from_table(read_csv(path), path); }

void write_curves(const std::filesystem::path& path, const Curves& curves) {
  write_csv(path, table_from_curves(curves));
}

}  // namespace hemibake
