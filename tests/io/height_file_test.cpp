// What is read of a file of heights: values, and what the file says about them.
#include <gmock/gmock.h>

#include <cmath>

#include "io/height_files.h"
#include "io/tiff_bytes.h"

namespace hemibake {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::FloatEq;
using testing::HasSubstr;

// ---- What the file says

TEST_F(HeightFiles, FactsOfEveryKind) {
  const auto expect = [&](const char* name, const char* format, const char* samples, double full_scale) {
    const HeightFile file = read(name);
    EXPECT_EQ(file.format, format) << name;
    EXPECT_EQ(file.sample_type, samples) << name;
    EXPECT_EQ(file.full_scale, full_scale) << name;
    EXPECT_EQ(file.channel, file.channels[0]) << name;
    EXPECT_TRUE(file.holes.values.empty()) << name;
    EXPECT_FALSE(file.in_metres) << name;
    EXPECT_EQ(file.orientation, 1) << name;
    EXPECT_EQ(file.pixel_aspect, 1) << name;
    return file.values.values;
  };
  const OIIO::ImageSpec spec = spec_of(2, 1, {"Y"});
  write_foreign(folder_ / "8.png", spec, std::vector<uint8_t>{0, 51});
  EXPECT_THAT(expect("8.png", "PNG", "8-bit integers", 255), ElementsAre(0, 0.2f));
  write_foreign(folder_ / "16.png", spec, std::vector<uint16_t>{0, 13107});
  EXPECT_THAT(expect("16.png", "PNG", "16-bit integers", 65535), ElementsAre(0, 0.2f));
  write_foreign(folder_ / "16.tif", spec, std::vector<uint16_t>{0, 13107});
  EXPECT_THAT(expect("16.tif", "TIFF", "16-bit integers", 65535), ElementsAre(0, 0.2f));
  write_foreign(folder_ / "i16.tif", spec, std::vector<int16_t>{-32767, 100});
  EXPECT_THAT(expect("i16.tif", "TIFF", "signed 16-bit integers", 32767),
              ElementsAre(-1, FloatEq(100 / 32767.0f)));
  write_foreign(folder_ / "f.exr", spec, std::vector<float>{-3, 1500.25f});
  EXPECT_THAT(expect("f.exr", "OpenEXR", "32-bit floats", 1), ElementsAre(-3, 1500.25f));
  OIIO::ImageSpec half = spec;
  half.set_format(OIIO::TypeDesc::HALF);
  write_foreign(folder_ / "h.exr", half, std::vector<float>{-3, 0.5f});
  EXPECT_THAT(expect("h.exr", "OpenEXR", "half floats", 1), ElementsAre(-3, 0.5f));
}

// The stored rows are 1 2 3 / 4 5 6. Tables: EXIF 2.3, tag 274, where row 0 and column 0 stand.
TEST_F(HeightFiles, OrientationsComeOutUpright) {
  const std::vector<std::vector<int>> upright{{1, 2, 3, 4, 5, 6}, {3, 2, 1, 6, 5, 4}, {6, 5, 4, 3, 2, 1},
                                              {4, 5, 6, 1, 2, 3}, {1, 4, 2, 5, 3, 6}, {4, 1, 5, 2, 6, 3},
                                              {6, 3, 5, 2, 4, 1}, {3, 6, 2, 5, 1, 4}};
  for (int orientation = 1; orientation <= 8; ++orientation) {
    OIIO::ImageSpec spec = spec_of(3, 2, {"Y"});
    spec.attribute("Orientation", orientation);
    write_foreign(folder_ / "turned.tif", spec, std::vector<uint8_t>{1, 2, 3, 4, 5, 6});
    const HeightFile file = read("turned.tif");
    EXPECT_EQ(file.values.width, orientation > 4 ? 2 : 3);
    EXPECT_EQ(file.orientation, orientation);
    const ImageHeader header = read_image_header(folder_ / "turned.tif");
    EXPECT_EQ(header.width, file.values.width);
    const ColorImage color = read_color_image(folder_ / "turned.tif");
    for (size_t i = 0; i < 6; ++i) {
      EXPECT_EQ(std::lround(255 * file.values[i]), upright[static_cast<size_t>(orientation - 1)][i])
          << orientation << " at " << i;
      EXPECT_EQ(color.colors[i].x, file.values[i]);
    }
  }
}

TEST_F(HeightFiles, TheReferenceMapIsItsGreen) {
  const std::filesystem::path path = HEMIBAKE_REFERENCE_DIR "/WallHeight.png";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  const HeightFile file = read_height_file(path, {});
  EXPECT_EQ(file.values.values, read_height_map(path, "G").values);
  EXPECT_EQ(file.channel, "G");
  EXPECT_EQ(file.pixel_aspect, 1);
  EXPECT_TRUE(file.holes.values.empty());
  EXPECT_THAT(error_of<InputError>([] { read_height_file(HEMIBAKE_REFERENCE_DIR "/WallNormal.png", {}); }),
              HasSubstr("looks like a normal map"));
}

TEST_F(HeightFiles, TurnedNormalMapsAreRefused) {
  OIIO::ImageSpec spec = spec_of(2, 1, {"R", "G", "B"});
  spec.attribute("Orientation", 6);
  write_foreign(folder_ / "n.tif", spec, std::vector<uint8_t>{128, 128, 255, 128, 128, 255});
  EXPECT_THAT(error_of<InputError>([&] { read_normal_map(folder_ / "n.tif", 1, 2); }),
              HasSubstr("n.tif: is stored turned (orientation 6)"));
}

TEST_F(HeightFiles, PixelAspectIsWidthOverHeight) {
  OIIO::ImageSpec spec = spec_of(2, 1, {"Y"});
  spec.attribute("PixelAspectRatio", 2.0f);
  write_foreign(folder_ / "a.exr", spec, std::vector<float>{0, 1});
  EXPECT_EQ(read("a.exr").pixel_aspect, 2);
  OIIO::ImageSpec resolutions = spec_of(2, 1, {"Y"});
  resolutions.attribute("XResolution", 100.0f);  // per inch: texels are three times as wide as high
  resolutions.attribute("YResolution", 300.0f);
  resolutions.attribute("ResolutionUnit", "in");
  for (const char* name : {"a.png", "a.jpg"}) {
    write_foreign(folder_ / name, resolutions, std::vector<uint8_t>{0, 255});
    EXPECT_NEAR(read(name).pixel_aspect, 3, 3e-3) << name;  // PNG rounds to whole texels per metre
  }
  const auto tiff = [&](char y_resolution, int orientation) {
    resolutions.attribute("Orientation", orientation);
    write_foreign(folder_ / "a.tif", resolutions, std::vector<uint8_t>{0, 255});
    // OpenImageIO writes the same for both axes.
    using namespace std::string_literals;
    std::string bytes = read_bytes(folder_ / "a.tif");
    const size_t at = bytes.find("\x64\0\0\0\1\0\0\0\x64\0\0\0\1\0\0\0"s);
    EXPECT_NE(at, std::string::npos);
    bytes[at + 8] = y_resolution;
    write_bytes(folder_ / "a.tif", bytes);
    return read("a.tif").pixel_aspect;
  };
  EXPECT_NEAR(tiff(50, 1), 0.5, 1e-6);
  EXPECT_NEAR(tiff(50, 6), 2, 1e-6);
  EXPECT_EQ(tiff(100, 1), 1);
  resolutions.attribute("XResolution", 299.9f);
  write_foreign(folder_ / "square.png", resolutions, std::vector<uint8_t>{0, 255});
  EXPECT_EQ(read("square.png").pixel_aspect, 1);
}

// ---- Files of several images

TEST_F(HeightFiles, WebpIsRead) {
  OIIO::ImageSpec spec = spec_of(16, 16, {"R", "G", "B"});
  std::vector<uint8_t> values;
  for (int i = 0; i < 256; ++i) values.insert(values.end(), 3, static_cast<uint8_t>(i));
  write_foreign(folder_ / "a.webp", spec, values);
  const HeightFile file = read("a.webp");
  EXPECT_EQ(file.format, "WebP");
  for (size_t i = 0; i < 256; ++i)
    EXPECT_NEAR(255 * file.values[i], static_cast<double>(i), 3.001) << i;  // written with loss
  EXPECT_EQ(read_height_map(folder_ / "a.webp").values, file.values.values);
  // OpenImageIO multiplies by alpha: only what is opaque is as stored.
  const auto write_alpha = [&](uint8_t alpha) {
    std::vector<uint8_t> texels;
    for (int i = 0; i < 256; ++i)
      texels.insert(texels.end(), {100, 100, 100, i < 128 ? alpha : uint8_t{255}});
    write_foreign(folder_ / "alpha.webp", spec_of(16, 16, {"R", "G", "B", "A"}), texels);
  };
  write_alpha(0);
  const HeightFile masked = read("alpha.webp");
  EXPECT_THAT(masked.holes.values, testing::Contains(1).Times(128));
  EXPECT_NEAR(255 * masked.values[200], 100, 3);
  write_alpha(200);
  EXPECT_THAT(fault("alpha.webp"), HasSubstr("alpha.webp: is a WebP with partial or no opacity"));
}

// EXIF of one entry, the orientation.
std::string exif_of(int orientation) {
  using namespace std::string_literals;
  return "MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0"s + static_cast<char>(orientation) +
         "\0\0\0\0\0\0"s;
}

TEST_F(HeightFiles, OrientationsOfPhotographersFormats) {
  const auto write_ramp = [&](const char* name, int orientation) {
    OIIO::ImageSpec spec = spec_of(32, 16, {"R", "G", "B"});
    if (orientation > 0) spec.attribute("Orientation", orientation);
    std::vector<uint8_t> values;
    for (int i = 0; i < 512; ++i) values.insert(values.end(), 3, static_cast<uint8_t>(i % 32 * 8));
    write_foreign(folder_ / name, spec, values);
  };
  // Turned by 90 degrees clockwise: what grows to the right grows down.
  const auto expect_turned = [&](const char* name) {
    const HeightFile file = read(name);
    EXPECT_EQ(file.orientation, 6) << name;
    ASSERT_EQ(file.values.width, 16) << name;
    for (int y = 0; y < 32; ++y) EXPECT_NEAR(255 * file.values(3, y), 8 * y, 6) << name;
  };
  write_ramp("a.jpg", 6);
  expect_turned("a.jpg");
  write_ramp("plain.webp", 0);
  const std::string body = read_bytes(folder_ / "plain.webp").substr(12);
  for (const std::string& mark : {std::string(), std::string("Exif\0\0", 6)}) {
    const std::string exif = mark + exif_of(6);
    const auto length = [](size_t size) { return std::string{static_cast<char>(size), 0, 0, 0}; };
    const std::string extended = std::string("VP8X\x0a\0\0\0\x08\0\0\0\x1f\0\0\x0f\0\0", 18);
    const std::string all = "WEBP" + extended + body + "EXIF" + length(exif.size()) + exif;
    std::string size = length(all.size());
    size[1] = static_cast<char>(all.size() >> 8);
    write_bytes(folder_ / "a.webp", "RIFF" + size + all);
    expect_turned("a.webp");
  }
}

TEST_F(HeightFiles, OverviewsAndMasksAreNoFurtherImages) {
  for (const bool is_big_endian : {false, true}) {
    write_bytes(folder_ / "cog.tif", tiff_bytes({{4, 4, 0, std::string(16, 'a'), ""},
                                                 {4, 4, 4, std::string(16, '\0'), ""},
                                                 {2, 2, 1, std::string(4, 'b'), ""},
                                                 {2, 2, 5, std::string(4, '\0'), ""}},
                                                is_big_endian));
    const HeightFile file = read("cog.tif");
    EXPECT_EQ(file.values.width, 4);
    EXPECT_EQ(file.values[5], static_cast<float>('a' / 255.0));
    write_bytes(
        folder_ / "thumbnail.tif",
        tiff_bytes({{2, 2, 1, std::string(4, 'b'), ""}, {4, 4, 0, std::string(16, 'a'), ""}}, is_big_endian));
    EXPECT_EQ(read("thumbnail.tif").values[15], static_cast<float>('a' / 255.0));
    EXPECT_EQ(read("thumbnail.tif", part(0)).values.width, 4);
    EXPECT_THAT(
        fault("thumbnail.tif", part(1)),
        EndsWith("thumbnail.tif: holds 1 image(s), counted from 0, expected one of them, not --part 1"));
  }
}

TEST_F(HeightFiles, PartsAreChosen) {
  write_bytes(folder_ / "pages.tif",
              tiff_bytes({{2, 1, 0, "ab", ""}, {1, 1, 1, "x", ""}, {1, 2, 0, "cd", ""}}, false));
  EXPECT_THAT(fault("pages.tif"), EndsWith("pages.tif: holds 2 images, expected one, or --part 0 to 1"));
  EXPECT_EQ(read("pages.tif", part(0)).values[1], static_cast<float>('b' / 255.0));
  EXPECT_EQ(read("pages.tif", part(1)).values[1], static_cast<float>('d' / 255.0));
  EXPECT_EQ(read("pages.tif", part(1)).values.height, 2);
  EXPECT_THAT(fault("pages.tif", part(2)), HasSubstr("not --part 2"));
  write_foreign(folder_ / "parts.exr", spec_of(1, 1, {"Y"}), std::vector<float>{7}, 3);
  EXPECT_THAT(fault("parts.exr"), EndsWith("parts.exr: holds 3 images, expected one, or --part 0 to 2"));
  EXPECT_EQ(read("parts.exr", part(2)).values[0], 7);
  EXPECT_THAT(fault("parts.exr", part(3)), HasSubstr("holds 3 image(s)"));
}

TEST_F(HeightFiles, DataWindowOnDemand) {
  OIIO::ImageSpec spec = spec_of(2, 2, {"Y"});
  spec.x = 1;
  spec.full_width = spec.full_height = 4;
  write_foreign(folder_ / "crop.exr", spec, std::vector<float>{1, 2, 3, 4});
  EXPECT_THAT(fault("crop.exr"), EndsWith("expected the same window for both, or --window data"));
  HeightFileOptions options;
  options.window = ImageWindow::kData;
  EXPECT_THAT(read("crop.exr", options).values.values, ElementsAre(1, 2, 3, 4));
}

// ---- PGM and PPM

TEST_F(HeightFiles, PgmOfAnyLargestValueIsExact) {
  for (const int most : {1, 3, 100, 127, 254, 255, 256, 1000, 4095, 65534, 65535}) {
    std::string bytes = "P5\n# a comment\n2 2 # another\n" + std::to_string(most) + "\n";
    std::string text = "P2 2 2\n" + std::to_string(most) + "\n";
    const std::vector<int> values{0, most / 3, most - 1, most};
    for (const int value : values) {
      if (most > 255) bytes += static_cast<char>(value >> 8);
      bytes += static_cast<char>(value);
      text += std::to_string(value) + " ";
    }
    write_bytes(folder_ / "a.pgm", bytes);
    write_bytes(folder_ / "t.pgm", text);
    for (const char* name : {"a.pgm", "t.pgm"}) {
      const HeightFile file = read(name);
      EXPECT_EQ(file.format, "PGM");
      EXPECT_EQ(file.full_scale, most);
      EXPECT_EQ(file.sample_type, most > 255 ? "16-bit integers" : "8-bit integers");
      for (size_t i = 0; i < 4; ++i)
        EXPECT_EQ(file.values[i], static_cast<float>(static_cast<double>(values[i]) / most)) << most;
    }
  }
  write_bytes(folder_ / "a.ppm", "P6 1 2 255\n\x01\x33\x02\x03\x66\x04");
  HeightFileOptions green;
  green.channel = "G";
  EXPECT_THAT(read("a.ppm", green).values.values, ElementsAre(0.2f, 0.4f));
}

TEST_F(HeightFiles, BrokenPgmIsRefused) {
  const auto expect = [&](const std::string& bytes, const char* reason) {
    write_bytes(folder_ / "b.pgm", bytes);
    EXPECT_THAT(fault("b.pgm"), AllOf(HasSubstr("b.pgm: "), HasSubstr(reason))) << bytes;
  };
  expect("P5 2 2 255\nabc", "is cut short, expected 2 x 2 texels");
  expect("P5 2 2 300\nabcdefg", "is cut short");
  expect("P5 0 2 255\n", "expected at least one texel");
  expect("P5 2 2 65536\nabcdefgh", "values to 1 .. 65535");
  expect("P5 2 2 99999999999\nabcdefgh", "values to 1 .. 65535");
  expect("P5 2", "expected at least one texel");
  expect("P5 #", "expected at least one texel");
  expect("P5 99999999 99999999 255\n", "texels, expected at most");
  expect("P2 2 2 9\n1 2 3", "has no number at texel 1,1");
  expect("P2 2 1 9\n1 10", "has value 10 at texel 1,0, expected 0 to 9");
}

// ---- Holes

TEST_F(HeightFiles, NotANumberIsAHole) {
  for (const char* name : {"a.exr", "a.tif"}) {
    write_foreign(folder_ / name, spec_of(3, 1, {"Y"}), std::vector<float>{1, NAN, 3});
    const HeightFile file = read(name);
    EXPECT_THAT(file.values.values, ElementsAre(1, 0, 3));
    EXPECT_THAT(file.holes.values, ElementsAre(0, 1, 0));
    write_foreign(folder_ / name, spec_of(3, 1, {"Y"}), std::vector<float>{1, INFINITY, 3});
    EXPECT_THAT(fault(name), EndsWith("height is inf at texel 1,0, expected a finite number"));
    write_foreign(folder_ / name, spec_of(1, 1, {"Y"}), std::vector<float>{NAN});
    EXPECT_THAT(fault(name), EndsWith("has no height in any texel, expected some"));
  }
}

TEST_F(HeightFiles, NoDataIsTheStoredValue) {
  write_foreign(folder_ / "a.png", spec_of(3, 1, {"Y"}), std::vector<uint16_t>{7, 8, 65535});
  EXPECT_THAT(read("a.png", no_data(8)).holes.values, ElementsAre(0, 1, 0));
  EXPECT_THAT(read("a.png", no_data(65535)).holes.values, ElementsAre(0, 0, 1));
  EXPECT_TRUE(read("a.png", no_data(9)).holes.values.empty());
  write_foreign(folder_ / "f.exr", spec_of(3, 1, {"Y"}), std::vector<float>{7, -9999, -3.4028235e38f});
  EXPECT_THAT(read("f.exr", no_data(-9999)).holes.values, ElementsAre(0, 1, 0));
  EXPECT_THAT(read("f.exr", no_data(-3.4e38)).holes.values, ElementsAre(0, 0, 1));
  write_bytes(folder_ / "r.raw", bytes_of<int16_t>({-32768, 0, 5}));
  HeightFileOptions options = raw("3x1:i16le");
  options.no_data = -32768;
  EXPECT_THAT(read("r.raw", options).holes.values, ElementsAre(1, 0, 0));
  write_foreign(folder_ / "i.tif", spec_of(3, 1, {"Y"}), std::vector<int16_t>{-32768, -32767, 5});
  EXPECT_THAT(read("i.tif", no_data(-32768)).holes.values, ElementsAre(1, 0, 0));
}

TEST_F(HeightFiles, TaggedNoDataIsFound) {
  for (const bool is_big_endian : {false, true}) {
    write_bytes(folder_ / "a.tif", tiff_bytes({{3, 1, 0, "\x07\x08\x09", "8"}}, is_big_endian));
    EXPECT_THAT(read("a.tif").holes.values, ElementsAre(0, 1, 0));
    EXPECT_THAT(read("a.tif", no_data(9)).holes.values, ElementsAre(0, 0, 1));
    write_bytes(folder_ / "b.tif", tiff_bytes({{3, 1, 0, "\x07\x08\x09", "-9999.000000"}}, is_big_endian));
    EXPECT_TRUE(read("b.tif").holes.values.empty());
  }
}

TEST_F(HeightFiles, TransparentTexelsAreHoles) {
  OIIO::ImageSpec spec = spec_of(3, 1, {"Y", "A"});
  spec.attribute("oiio:UnassociatedAlpha", 1);
  for (const char* name : {"a.png", "a.tif"}) {
    write_foreign(folder_ / name, spec, std::vector<uint8_t>{51, 255, 77, 0, 102, 255});
    const HeightFile file = read(name);
    EXPECT_THAT(file.values.values, ElementsAre(0.2f, 0, 0.4f)) << name;
    EXPECT_THAT(file.holes.values, ElementsAre(0, 1, 0)) << name;
    write_foreign(folder_ / name, spec, std::vector<uint8_t>{51, 0, 77, 0, 102, 0});  // says nothing
    EXPECT_TRUE(read(name).holes.values.empty());
    write_foreign(folder_ / name, spec, std::vector<uint8_t>{51, 0, 77, 100, 102, 200});  // data, no mask
    EXPECT_TRUE(read(name).holes.values.empty());
  }
  HeightFileOptions alpha;
  alpha.channel = "A";
  EXPECT_THAT(read("a.png", alpha).values.values.front(), 0);
  EXPECT_TRUE(read("a.png", alpha).holes.values.empty());
}

}  // namespace
}  // namespace hemibake
