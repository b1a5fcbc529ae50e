// Makes the maps of heightmaps/ again by the lines recorded beside them, and compares every pixel.
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "cli/run_hemibake.h"
#include "io/image_io.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

// A `hemibake synth … -o heightmaps/NAME` line of heightmaps/README.md.
struct RecordedLine {
  std::string arguments;  // up to -o
  std::string name;
};

std::vector<RecordedLine> recorded_lines(const fs::path& readme) {
  const std::string program = "hemibake ", output = " -o heightmaps/";
  std::vector<RecordedLine> lines;
  std::ifstream file(readme);
  for (std::string line; std::getline(file, line);) {
    const size_t start = line.find_first_not_of(' ');
    if (start == std::string::npos || line.compare(start, program.size(), program) != 0) continue;
    const size_t split = line.find(output);
    if (split == std::string::npos) {
      ADD_FAILURE() << "does not end in" << output << "NAME: " << line;
      continue;
    }
    const size_t arguments = start + program.size();
    lines.push_back({line.substr(arguments, split - arguments), line.substr(split + output.size())});
  }
  return lines;
}

TEST(Heightmaps, AreMadeByTheRecordedLines) {
  const fs::path stored = fs::path(HEMIBAKE_SOURCE_DIR) / "heightmaps";
  const TemporaryFolder folder;
  std::set<std::string> made;
  for (const RecordedLine& line : recorded_lines(stored / "README.md")) {
    const fs::path again = folder / line.name;
    const auto result = run_hemibake(line.arguments + " -o " + again.string());
    ASSERT_EQ(result.exit_code, 0) << line.arguments << "\n" << result.standard_error;
    const Grid<float> expected = read_height_map(stored / line.name), actual = read_height_map(again);
    EXPECT_EQ(actual.width, expected.width) << line.name;
    EXPECT_TRUE(actual.values == expected.values) << line.name;
    made.insert(line.name);
  }
  for (const auto& file : fs::directory_iterator(stored)) {
    const std::string name = file.path().filename().string();
    EXPECT_TRUE(name == "README.md" || made.contains(name)) << name << " has no line in heightmaps/README.md";
  }
  EXPECT_FALSE(made.empty());
}

}  // namespace
}  // namespace hemibake
