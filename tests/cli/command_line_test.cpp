#include "cli/command_line.h"

#include <gtest/gtest.h>

#include <vector>

namespace hemibake {
namespace {

std::string line_of(const std::vector<std::string>& arguments) { return command_line(arguments); }

TEST(CommandLine, IsQuotedForAShell) {
  EXPECT_EQ(line_of({"/usr/bin/hemibake", "bake", "my map.png", "--size", "0.5", "it's", ""}),
            "hemibake bake 'my map.png' --size 0.5 'it'\\''s' ''");
}

TEST(CommandLine, HoldsNothingThatChangesNoByte) {
  EXPECT_EQ(
      line_of({"hemibake", "bake", "a.png", "--threads", "2", "-o", "out.exr", "--rays", "64", "--json"}),
      "hemibake bake a.png --rays 64");
  EXPECT_EQ(
      line_of({"hemibake", "bake", "--threads=2", "--output=b.exr", "-oc.exr", "--output", "d", "a.png"}),
      "hemibake bake a.png");
  EXPECT_EQ(line_of({"hemibake", "bake", "-o"}), "hemibake bake");
  EXPECT_EQ(line_of({}), "hemibake");
}

}  // namespace
}  // namespace hemibake
