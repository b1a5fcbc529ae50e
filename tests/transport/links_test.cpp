#include "transport/links.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "core/parallel.h"

namespace hemibake {
namespace {

// Row i links to i+1 with ¼ and to 0 with ½.
Links ring(uint32_t rows) {
  Links links = make_links(rows, rows);
  for (uint32_t i = 0; i < rows; ++i) {
    const std::vector<Link> row{{0, 0.5f}, {(i + 1) % rows, 0.25f}};
    append_row(links.blocks[i / Links::kRowsPerBlock], row);
  }
  return links;
}

TEST(Links, GatherIsTheMatrixProduct) {
  const uint32_t rows = 3 * Links::kRowsPerBlock + 17;
  const Links links = ring(rows);
  EXPECT_EQ(links.count(), 2u * rows);
  std::vector<double> values(rows), out(rows);
  for (uint32_t i = 0; i < rows; ++i) values[i] = i + 1;
  gather(links, values, out);
  for (uint32_t i = 0; i < rows; ++i) EXPECT_DOUBLE_EQ(out[i], 0.5 + 0.25 * ((i + 1) % rows + 1));
  for (const double sum : row_sums(links)) EXPECT_EQ(sum, 0.75);
}

TEST(Links, WrongLengthsAreABug) {
  const Links links = ring(8);
  std::vector<double> values(7), out(8);
  EXPECT_THROW(gather(links, values, out), std::logic_error);
}

TEST(Links, EmptyRowsAreFine) {
  Links links = make_links(2, 2);
  append_row(links.blocks[0], {});
  append_row(links.blocks[0], {});
  for (const double sum : row_sums(links)) EXPECT_EQ(sum, 0);
}

}  // namespace
}  // namespace hemibake
