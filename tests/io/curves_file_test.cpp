#include "io/curves_file.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace hemibake {
namespace {

Curves make_example() {
  Curves curves;
  curves.bounce_count = 2;
  curves.bins = {{0, 0.5, 0.25, 3, {{1.5, 0.125}, {0.5, 0.0625}}}, {0.5, 1, 0, 0, {{}, {}}}};
  return curves;
}

// The complaint about a table, without its path.
std::string complaint(const Table& table) {
  try {
    curves_from_table(table, "c.csv");
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(CurvesFile, TableIsTheContractOfTheDesign) {
  const Table table = table_from_curves(make_example());
  EXPECT_EQ(table.columns, (std::vector<std::string>{"bin", "ao_low", "ao_high", "ao_mean", "count",
                                                     "E00_mean", "E00_stddev", "E01_mean", "E01_stddev"}));
  using Row = std::vector<std::optional<double>>;
  EXPECT_EQ(table.rows[0], (Row{0, 0, 0.5, 0.25, 3, 1.5, 0.125, 0.5, 0.0625}));
  const std::optional<double> empty;
  EXPECT_EQ(table.rows[1], (Row{1, 0.5, 1, empty, 0, empty, empty, empty, empty}));
}

TEST(CurvesFile, ReadsBackWhatWasWritten) {
  const Table table = table_from_curves(make_example());
  const Curves curves = curves_from_table(table, "c.csv");
  EXPECT_TRUE(curves.has_counts);
  EXPECT_EQ(curves.bounce_count, 2);
  EXPECT_EQ(table_from_curves(curves).rows, table.rows);
}

TEST(CurvesFile, CurvesOverVisibilityNameItInTheirColumns) {
  Curves curves = make_example();
  curves.index = CurveIndex::kVisibility;
  Table table = table_from_curves(curves);
  EXPECT_EQ(
      std::vector<std::string>(table.columns.begin(), table.columns.begin() + 5),
      (std::vector<std::string>{"bin", "visibility_low", "visibility_high", "visibility_mean", "count"}));
  const Curves read = curves_from_table(table, "c.csv");
  EXPECT_EQ(read.index, CurveIndex::kVisibility);
  EXPECT_EQ(table_from_curves(read).rows, table.rows);
  table.rows[1][1] = 0.25;
  EXPECT_EQ(complaint(table), "c.csv:3: visibility_low is 0.25, expected 0.5 where the bin before ends");
}

TEST(CurvesFile, ReadsThePublishedFormat) {
  const Table table{{"bin", "E0", "E1", "sum_over_pi"}, {{0, 0.5, 0.25, 0.3}, {1, 2, 0.5, 0.9}}};
  const Curves curves = curves_from_table(table, "c.csv");
  EXPECT_FALSE(curves.has_counts);
  EXPECT_EQ(curves.bounce_count, 2);
  EXPECT_EQ(curves.bins[1].low, 0.5);
  EXPECT_EQ(curves.bins[1].bounces[0].mean, 2);
}

TEST(CurvesFile, BadCellsAreNamed) {
  Table table = table_from_curves(make_example());
  table.rows[0][4] = -3;
  EXPECT_EQ(complaint(table), "c.csv:2: count is -3, expected a number from 0");
  table.rows[0][4] = 2.5;
  EXPECT_EQ(complaint(table), "c.csv:2: count is 2.5, expected a whole number");
  table.rows[0][4] = 3;
  table.rows[0][5].reset();
  EXPECT_EQ(complaint(table), "c.csv:2: E00_mean is empty, expected a number");
  table.rows[0][5] = 1.5;
  table.rows[1][1] = 0.25;
  EXPECT_EQ(complaint(table), "c.csv:3: ao_low is 0.25, expected 0.5 where the bin before ends");
  table.rows[1][1] = 0.5;
  table.rows[1][0] = 7;
  EXPECT_EQ(complaint(table), "c.csv:3: bin is 7, expected 1");
  table.rows[1][0] = 1;
  EXPECT_EQ(complaint(table), "none");
}

TEST(CurvesFile, BadTablesAreNamed) {
  EXPECT_EQ(complaint({{"x", "y"}, {{1, 2}}}),
            "c.csv: no column count, expected curves as 'hemibake curves' writes them");
  EXPECT_EQ(complaint({{"bin", "E0"}, {}}), "c.csv: no bins, expected a line for each");
  EXPECT_EQ(complaint({{"bin", "count", "E00_mean"}, {{0, 1, 1}}}), "c.csv: no column ao_low, expected one");
}

}  // namespace
}  // namespace hemibake
