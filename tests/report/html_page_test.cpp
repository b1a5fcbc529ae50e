#include "report/html_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace hemibake {
namespace {

using nlohmann::ordered_json;
using testing::HasSubstr;
using testing::Not;

TEST(HtmlPage, DataStandInTheirPlaces) {
  PackedPlanes planes;
  planes.planes.push_back({"ao", 1, "QUJD"});
  EXPECT_EQ(fill_page("a<!-- title -->b<!-- data -->c<!-- planes -->d", {{"title", "t"}}, planes, {}),
            "atb<script id=\"data\" type=\"application/json\">{\"title\":\"t\"}</script>c"
            "<script class=\"plane\" type=\"text/plain\" data-name=\"ao\">QUJD</script>\nd");
}

// A map may be called anything.
TEST(HtmlPage, NamesCannotLeaveTheirPlaces) {
  const std::string name = "</script><script>alert(1)</script>&.png<!-- planes -->\xff";
  const std::string page =
      fill_page("<title><!-- title --></title><!-- data -->|<!-- planes -->", {{"title", name}}, {}, {});
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page, HasSubstr("<title>&lt;/script>&lt;script>alert(1)&lt;/script>&amp;.png"));
  const size_t from = page.find('{'), to = page.rfind('}');
  const std::string json = page.substr(from, to - from + 1);
  EXPECT_EQ(json.find('<'), std::string::npos);
  EXPECT_THAT(ordered_json::parse(json).at("title").get<std::string>(),
              HasSubstr("</script><script>alert(1)</script>"));
}

TEST(HtmlPage, TemplateWithoutAPlaceIsABug) {
  EXPECT_THROW(fill_page("<!-- title --><!-- planes -->", {{"title", "t"}}, {}, {}), std::logic_error);
}

// This build's own page: whole, and with nothing to fetch.
TEST(HtmlPage, TemplateOfThisBuild) {
  const std::string page(page_template());
  if (page.empty()) GTEST_SKIP() << "this build has no report";
  for (const char* part : {"<!doctype html>", "<!-- title -->", "<!-- data -->", "<!-- planes -->", "</html>",
                           "default-src 'none'"})
    EXPECT_THAT(page, HasSubstr(part));
  for (const char* part :
       {"<!-- style -->", "<!-- script -->", "<script src", "<link rel=\"stylesheet\"", "@import"})
    EXPECT_THAT(page, Not(HasSubstr(part)));
  EXPECT_LT(page.size(), 1'000'000U);
}

}  // namespace
}  // namespace hemibake
