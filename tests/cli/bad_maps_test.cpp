// Refusal of maps and normal maps that cannot be baked, one by one.
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "cli/run_hemibake.h"
#include "io/image_io.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::AnyOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

class BadMaps : public CliTest {
 protected:
  void SetUp() override { write_map("map.png", SyntheticKind::kShapes, 32, 32); }

  void expect_bad_map(const std::string& map, const testing::Matcher<std::string>& line,
                      const std::string& options = "") const {
    expect_refusal(fmt::format("bake {} -o bake.exr --rays 4 {}", map, options), line);
  }

  // Writes a float map with one value that write_image would refuse.
  void write_map_with(const std::string& name, float bad) const {
    std::vector<float> heights(20, 0.25f);
    heights[13] = bad;
    const auto output = OIIO::ImageOutput::create((folder_ / name).string());
    OIIO::ImageSpec spec(5, 4, 1, OIIO::TypeDesc::FLOAT);
    spec.channelnames = {"Y"};
    ASSERT_TRUE(output && output->open((folder_ / name).string(), spec));
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, heights.data()));
    ASSERT_TRUE(output->close());
  }
};

TEST_F(BadMaps, AreNamed) {
  expect_bad_map("none.png", "none.png: No such file or directory, expected an image");
  expect_refusal("bake . -o bake.exr",
                 testing::Eq("--output: bake.exr is one file, expected a folder for several maps"));
  write_bytes(folder_ / "empty.png", "");
  expect_bad_map("empty.png", "empty.png: is empty, expected an image");
  write_bytes(folder_ / "text.png", "This is a letter and no picture.\n\nIt has several lines.\n");
  expect_bad_map("text.png", StartsWith("text.png: is not an image that can be read, expected PNG, TIFF"));
  write_bytes(folder_ / "text.exr", std::string(5000, 'x'));
  expect_bad_map("text.exr", StartsWith("text.exr: is not an image that can be read, expected PNG, TIFF"));
  write_bytes(folder_ / "map.unknown", "x");
  expect_bad_map("map.unknown",
                 StartsWith("map.unknown: is not an image that can be read, expected PNG, TIFF"));
  expect_bad_map("map.png", AllOf(StartsWith("map.png: has no channel 'Z', expected"), EndsWith(": Y")),
                 "--channel Z");
}

TEST_F(BadMaps, CutShort) {
  write_map("map.exr", SyntheticKind::kShapes, 32, 32);
  for (const std::string name : {"map.png", "map.exr"}) {
    const std::string whole = read_bytes(folder_ / name);
    // Cut in the signature, the header, the texels, and one byte before the end.
    for (const size_t length : {size_t{4}, size_t{20}, whole.size() / 2, whole.size() - 1}) {
      write_bytes(folder_ / ("cut_" + name), whole.substr(0, length));
      expect_bad_map("cut_" + name,
                     AnyOf(AllOf(StartsWith("cut_" + name + ": "), HasSubstr("expected")),
                           StartsWith("cut_" + name + ": is not an image that can be read (")));
    }
  }
}

TEST_F(BadMaps, OfARunLeaveNoFolder) {
  expect_refusal("run none.png -o results", "none.png: No such file or directory, expected an image");
  write_map("row.exr", SyntheticKind::kNoise, 8, 1);
  expect_refusal("run row.exr -o results --edge open", StartsWith("row.exr: "));
}

TEST_F(BadMaps, WithoutTexels) {
  // Width 0 in the header chunk of a PNG, and far too large a width: both break the chunk's CRC too.
  for (const std::string& width : {std::string(4, '\0'), std::string("\x7f\xff\xff\xff")}) {
    std::string bytes = read_bytes(folder_ / "map.png");
    write_bytes(folder_ / "size.png", bytes.replace(16, 4, width));
    expect_bad_map("size.png", AllOf(StartsWith("size.png: "), HasSubstr("expected")));
  }
}

TEST_F(BadMaps, ValuesThatAreNotFinite) {
  for (const float bad : {HUGE_VALF, -HUGE_VALF}) {
    write_map_with("bad.exr", bad);
    expect_bad_map("bad.exr", AllOf(StartsWith("bad.exr: "), HasSubstr("3,2"), HasSubstr("finite")));
  }
  write_map_with("bad.exr", std::numeric_limits<float>::quiet_NaN());
  expect_bad_map("bad.exr",
                 AllOf(StartsWith("bad.exr: "), HasSubstr("first 3,2"), HasSubstr("--holes fill")));
}

TEST_F(BadMaps, NeedTwoByTwoWithOpenEdges) {
  write_map("row.exr", SyntheticKind::kNoise, 8, 1);
  expect_bad_map("row.exr", AllOf(StartsWith("row.exr: "), HasSubstr("expected")), "--edge open");
}

TEST_F(BadMaps, TooSteepForTheirSize) {
  expect_bad_map("map.png", AllOf(StartsWith("map.png: "), HasSubstr("expected")),
                 "--amplitude 1e9 --size 1e-9");
}

class BadNormals : public CliTest {
 protected:
  void SetUp() override {
    write_map("map.png", SyntheticKind::kShapes, 16, 16);
    write_normals("n.png", 16, 16, {0.5f, 0.5f, 1.0f});
  }

  void write_normals(const std::string& name, int width, int height, const glm::vec3& color) const {
    write_png8_rgb(folder_ / name, Grid<glm::vec3>(width, height, color), make_provenance("test"));
  }
  void expect_bad_normals(const std::string& options, const testing::Matcher<std::string>& line) const {
    expect_refusal("bake map.png -o bake.exr --rays 4 " + options, line);
  }
};

TEST_F(BadNormals, AreNamed) {
  expect_bad_normals("--normals n.png",
                     AllOf(StartsWith("n.png: "), HasSubstr("--normal-y up or --normal-y down")));
  expect_bad_normals("--normal-y up",
                     AllOf(StartsWith("--normal-y: "), HasSubstr("expected --normals FILE")));
  expect_bad_normals(
      "--normals n.png --normal-y left",
      AllOf(StartsWith("--normal-y: 'left'"), HasSubstr("{up,down,opengl,directx,gl,dx,auto}")));
  expect_bad_normals("--normals n.png --normal-y up --normals-from faces", StartsWith("--normals-from: "));
  expect_bad_normals("--normals none.png --normal-y up", StartsWith("none.png: No such file"));
  write_normals("wide.png", 17, 16, {0.5f, 0.5f, 1.0f});
  expect_bad_normals("--normals wide.png --normal-y up",
                     AllOf(StartsWith("wide.png: "), HasSubstr("17 x 16"), HasSubstr("expected 16 x 16")));
  write_normals("below.png", 16, 16, {0.5f, 0.5f, 0.0f});
  expect_bad_normals("--normals below.png --normal-y up", AllOf(StartsWith("below.png: "), HasSubstr("0,0")));
  expect_bad_normals("--normals map.png --normal-y up",
                     AllOf(StartsWith("map.png: "), HasSubstr("expected")));
  run_well("bake map.png -o bake.exr --rays 4 --normals n.png --normal-y up");
}

}  // namespace
}  // namespace hemibake
