#include "trade/plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hemibake {
namespace {

size_t occurrences(const std::string& text, const std::string& part) {
  size_t count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(Plot, DrawsEveryPointAndTheLegend) {
  Plot plot;
  plot.title = "a < b & c";
  plot.groups.push_back({"first", {{1, 0.1}, {10, 0.01}, {0, 1}}, {}});
  plot.groups.push_back({"second", {{100, 0.001}}, {{1, 1}, {100, 0.001}}});
  plot.front = {{1, 0.1}, {100, 0.001}};
  plot.front_label = "front";
  const std::string svg = svg_of(plot);
  EXPECT_THAT(svg, testing::HasSubstr("a &lt; b &amp; c"));
  // Three marks that can be drawn and two in the legend; two rings and one.
  EXPECT_EQ(occurrences(svg, "r=\"4\""), 5u);
  EXPECT_EQ(occurrences(svg, "r=\"8\""), 2u);
  EXPECT_EQ(occurrences(svg, "r=\"7\""), 1u);
  EXPECT_EQ(occurrences(svg, "<svg"), 1u);
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

TEST(Plot, WithoutPointsSaysSo) {
  EXPECT_THAT(svg_of({}), testing::HasSubstr("nothing to show"));
  Plot plot;
  plot.groups.push_back({"zero error", {{1, 0}}, {}});
  EXPECT_THAT(svg_of(plot), testing::HasSubstr("nothing to show"));
}

TEST(Plot, OnePointOnADecadeHasAnAxis) {
  Plot plot;
  plot.groups.push_back({"one", {{10, 0.1}}, {}});
  const std::string svg = svg_of(plot);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

}  // namespace
}  // namespace hemibake
