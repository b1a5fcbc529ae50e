#include "io/image_io.h"

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>

#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "core/context.h"
#include "io/foreign_images.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;
using testing::AnyOf;
using testing::EndsWith;
using testing::HasSubstr;

// ---- Values

TEST_F(ImageIo, EveryValueOf16BitsIsTheNearestFloatAndComesBack) {
  Grid<float> heights(256, 256);
  std::vector<uint16_t> integers(65536);
  for (size_t v = 0; v < 65536; ++v) {
    integers[v] = static_cast<uint16_t>(v);
    heights[v] = static_cast<float>(static_cast<double>(v) / 65535.0);
  }
  write_height_map(folder_ / "ours.png", heights, Provenance::object());
  EXPECT_EQ(read_height_map(folder_ / "ours.png").values, heights.values);
  for (const char* name : {"a.png", "a.tif"}) {
    write_foreign(folder_ / name, spec_of(256, 256, {"Y"}), integers);
    EXPECT_EQ(read_height_map(folder_ / name).values, heights.values) << name;
  }
}

TEST_F(ImageIo, EveryValueOf8BitsIsTheNearestFloat) {
  std::vector<uint8_t> integers(256);
  for (size_t v = 0; v < 256; ++v) integers[v] = static_cast<uint8_t>(v);
  for (const char* name : {"a.png", "a.tif", "a.bmp", "a.tga"}) {
    write_foreign(folder_ / name, spec_of(16, 16, {"Y"}), integers);
    const Grid<float> read = read_height_map(folder_ / name);
    for (size_t v = 0; v < 256; ++v)
      EXPECT_EQ(read[v], static_cast<float>(static_cast<double>(v) / 255.0)) << name;
  }
}

TEST_F(ImageIo, PngRoundsToNearest) {
  Grid<float> heights(3, 1);
  heights.values = {0.49f / 65535, 0.51f / 65535, 65534.6f / 65535};
  write_height_map(folder_ / "a.png", heights, Provenance::object());
  EXPECT_THAT(read_height_map(folder_ / "a.png").values,
              testing::ElementsAre(0.0f, static_cast<float>(1 / 65535.0), 1.0f));
}

TEST_F(ImageIo, FloatsAreKeptBitForBit) {
  Grid<float> heights(5, 2);
  heights.values = {0, -0.0f, 1e-45f, -3.4e38f, 3.4e38f, 0.1f, -7, 1, 65504, 1234567.9f};
  write_height_map(folder_ / "ours.exr", heights, Provenance::object());
  write_foreign(folder_ / "foreign.exr", spec_of(5, 2, {"height"}), heights.values);
  write_foreign(folder_ / "foreign.tif", spec_of(5, 2, {"Y"}), heights.values);
  for (const char* name : {"ours.exr", "foreign.exr", "foreign.tif"}) {
    const Grid<float> read = read_height_map(folder_ / name);
    EXPECT_EQ(std::memcmp(read.values.data(), heights.values.data(), 40), 0) << name;
  }
  EXPECT_EQ(read_image_header(folder_ / "ours.exr").channels, std::vector<std::string>{"Y"});
}

TEST_F(ImageIo, HalfFloatsAndTiles) {
  std::vector<float> values(70 * 90);
  for (size_t i = 0; i < values.size(); ++i)
    values[i] = static_cast<float>(i % 2048) / 64;  // 11 bits: exact as half
  OIIO::ImageSpec spec = spec_of(70, 90, {"Y"});
  spec.set_format(OIIO::TypeDesc::HALF);
  write_foreign(folder_ / "half.exr", spec, values);
  EXPECT_EQ(read_height_map(folder_ / "half.exr").values, values);
  spec.tile_width = spec.tile_height = 32;
  write_foreign(folder_ / "tiles.exr", spec, values);
  EXPECT_EQ(read_height_map(folder_ / "tiles.exr").values, values);
  spec.set_format(OIIO::TypeDesc::FLOAT);
  write_foreign(folder_ / "tiles.tif", spec, values);
  EXPECT_EQ(read_height_map(folder_ / "tiles.tif").values, values);
}

TEST_F(ImageIo, AlphaNeverTouchesTheOthers) {
  // Premultiplying would turn 200 at alpha 51 (a fifth) into 40, and lose it where alpha is 0.
  const std::vector<uint8_t> values{10, 200, 30, 51, 10, 200, 30, 0};
  OIIO::ImageSpec spec = spec_of(2, 1, {"R", "G", "B", "A"});
  spec.attribute("oiio:UnassociatedAlpha", 1);
  for (const char* name : {"a.png", "a.tif", "a.tga"}) {
    write_foreign(folder_ / name, spec, values);
    const auto expected = static_cast<float>(200 / 255.0);
    EXPECT_THAT(read_height_map(folder_ / name).values, testing::ElementsAre(expected, expected)) << name;
    EXPECT_EQ(read_normal_map(folder_ / name, 2, 1).values[1].y, expected) << name;
  }
  write_foreign(folder_ / "a.exr", spec_of(1, 1, {"R", "G", "B", "A"}), std::vector<float>{1, 2, 3, 0.25f});
  EXPECT_EQ(read_height_map(folder_ / "a.exr")[0], 2);
}

TEST_F(ImageIo, NoColourTransform) {
  // A gamma or an sRGB mark in the file changes nothing.
  OIIO::ImageSpec spec = spec_of(1, 1, {"R", "G", "B"});
  for (const char* space : {"sRGB", "Linear", "GammaCorrected"}) {
    spec.attribute("oiio:ColorSpace", space);
    spec.attribute("oiio:Gamma", 2.2f);
    write_foreign(folder_ / "a.png", spec, std::vector<uint8_t>{1, 128, 3});
    EXPECT_EQ(read_height_map(folder_ / "a.png")[0], static_cast<float>(128 / 255.0)) << space;
  }
  write_height_map(folder_ / "ours.png", Grid<float>(1, 1, 0.5f), Provenance::object());
  EXPECT_THAT(read_bytes(folder_ / "ours.png"), testing::Not(AnyOf(HasSubstr("sRGB"), HasSubstr("gAMA"))));
}

// ---- Channels

TEST_F(ImageIo, ChannelChoice) {
  write_foreign(folder_ / "rgb.exr", spec_of(1, 1, {"R", "G", "B", "A"}), std::vector<float>{1, 2, 3, 4});
  const auto value = [&](const char* name, const char* channel) {
    return read_height_map(folder_ / name, channel)[0];
  };
  EXPECT_EQ(value("rgb.exr", ""), 2);
  EXPECT_EQ(value("rgb.exr", "R"), 1);
  EXPECT_EQ(value("rgb.exr", "b"), 3);
  EXPECT_EQ(value("rgb.exr", "3"), 4);
  for (const char* none : {"X", "4", "-1", "1x", "99999999999", " 1"})
    EXPECT_THAT(refusal("rgb.exr", none),
                EndsWith(std::string("rgb.exr: has no channel '") + none +
                         "', expected the name or index of one of its channels: R, G, B, A"));
  write_foreign(folder_ / "ya.png", spec_of(1, 1, {"Y", "A"}), std::vector<uint8_t>{51, 255});
  EXPECT_EQ(value("ya.png", ""), 0.2f);
  EXPECT_EQ(value("ya.png", "A"), 1);
  write_foreign(folder_ / "layers.exr", spec_of(1, 1, {"ground.height", "ground.slope"}),
                std::vector<float>{1, 2});
  EXPECT_THAT(refusal("layers.exr"),
              HasSubstr("has no channel G, expected the name or index of one of its channels: "
                        "ground.height, ground.slope"));
  EXPECT_EQ(value("layers.exr", "ground.slope"), 2);
  write_foreign(folder_ / "one.exr", spec_of(1, 1, {"Z"}), std::vector<float>{7});
  EXPECT_EQ(value("one.exr", ""), 7);
}

TEST_F(ImageIo, NormalMapSizeAndChannels) {
  write_foreign(folder_ / "n.png", spec_of(2, 1, {"R", "G", "B"}),
                std::vector<uint8_t>{0, 51, 102, 153, 204, 255});
  const Grid<glm::vec3> normals = read_normal_map(folder_ / "n.png", 2, 1).values;
  EXPECT_EQ(normals[0], glm::vec3(0, 0.2f, 0.4f));
  EXPECT_EQ(normals[1], glm::vec3(0.6f, 0.8f, 1));
  const auto refusal_of = [&](const char* name, int width, int height) {
    return error_of<InputError>([&] { read_normal_map(folder_ / name, width, height); });
  };
  EXPECT_THAT(refusal_of("n.png", 1, 2),
              EndsWith("n.png: is 2 x 1 texels, expected 1 x 2 as the height map is"));
  write_foreign(folder_ / "y.png", spec_of(2, 1, {"Y"}), std::vector<uint8_t>{0, 1});
  EXPECT_THAT(refusal_of("y.png", 2, 1),
              EndsWith("y.png: has 1 channel(s), expected the three of a normal map"));
}

TEST_F(ImageIo, PlanesByNameInOnePass) {
  const std::vector<float> a{1, 2, 3, 4}, b{5, 6, 7, 8};
  const std::vector<Plane> planes{{"first", a.data()}, {"second.X", b.data()}};
  write_image(folder_ / "p.exr", 2, 2, planes, Provenance::object());
  std::vector<float> read(8);
  read_planes(folder_ / "p.exr", 2, 2,
              std::vector<MutablePlane>{{"second.X", &read[1], 2}, {"first", &read[0], 2}});
  EXPECT_THAT(read, testing::ElementsAre(1, 5, 2, 6, 3, 7, 4, 8));
  EXPECT_THROW(read_planes(folder_ / "p.exr", 4, 1, std::vector<MutablePlane>{{"first", read.data()}}),
               InputError);
  EXPECT_THROW(read_planes(folder_ / "p.exr", 2, 2, std::vector<MutablePlane>{{"third", read.data()}}),
               InputError);
}

// ---- Writing

TEST_F(ImageIo, PngRefusesWhatItCannotHold) {
  for (const float bad : {-0.001f, 1.001f}) {
    Grid<float> heights(3, 2, 0.5f);
    heights(2, 1) = bad;
    EXPECT_THAT(
        error_of<InputError>([&] { write_height_map(folder_ / "a.png", heights, Provenance::object()); }),
        AllOf(HasSubstr("a.png: channel Y is "), HasSubstr("at texel 2,1, expected 0..1 in a PNG")));
  }
  const std::vector<float> zeros(1);
  const std::vector<Plane> five(5, {"a", zeros.data()});
  EXPECT_THAT(error_of<InputError>([&] { write_image(folder_ / "a.png", 1, 1, five, Provenance::object()); }),
              HasSubstr("5 channels do not fit a PNG"));
  EXPECT_THAT(error_of<InputError>([&] {
                write_height_map(folder_ / "a.jpg", {1, 1}, Provenance::object());
              }),
              EndsWith("a.jpg: cannot write '.jpg' files, expected .exr or .png"));
  EXPECT_THROW(write_height_map(folder_ / "a.exr", {}, Provenance::object()), std::logic_error);
  EXPECT_THROW(write_height_map(folder_ / "a.exr", {1, 1, NAN}, Provenance::object()), std::logic_error);
  EXPECT_EQ(folder_.count(), 0u);
}

TEST_F(ImageIo, ProvenanceOfExrAndPng) {
  const Provenance provenance{
      {"version", "0"}, {"seed", int64_t{1} << 50}, {"kind", "bricks"}, {"size_m", 0.5}};
  for (const char* name : {"a.exr", "a.png"}) {
    write_height_map(folder_ / name, Grid<float>(2, 2), provenance);
    EXPECT_EQ(read_image_header(folder_ / name).provenance.dump(), provenance.dump()) << name;
  }
  const auto input = OIIO::ImageInput::open((folder_ / "a.exr").string());
  EXPECT_EQ(input->spec().get_string_attribute("hemibake:kind"), "bricks");
  EXPECT_EQ(input->spec().get_string_attribute("hemibake:seed"), "1125899906842624");
  EXPECT_EQ(input->spec().get_float_attribute("hemibake:size_m"), 0.5f);
  write_foreign(folder_ / "foreign.exr", spec_of(1, 1, {"Y"}), std::vector<float>(1));
  EXPECT_TRUE(read_image_header(folder_ / "foreign.exr").provenance.is_null());
}

TEST_F(ImageIo, PicturesAreClampedAndRounded) {
  Grid<glm::vec3> picture(2, 1);
  picture[0] = {-1, 0.5f, 2};
  picture[1] = {0.2f, 0.4f, 0.6f};
  write_png8_rgb(folder_ / "p.png", picture, {{"version", "0"}});
  const Grid<glm::vec3> read = read_normal_map(folder_ / "p.png", 2, 1).values;
  EXPECT_EQ(read[0], glm::vec3(0, static_cast<float>(128 / 255.0), 1));
  EXPECT_EQ(read[1], picture[1]);
  picture[1].z = NAN;
  EXPECT_THROW(write_png8_rgb(folder_ / "q.png", picture, Provenance::object()), std::logic_error);
  EXPECT_EQ(folder_.count(), 1u);
}

TEST_F(ImageIo, FullDiskIsOneLineAndLeavesNothing) {
  const SmallDisk disk;
  if (!disk.mounted()) GTEST_SKIP() << "may not mount a disk";
  Grid<float> noise(300, 300);
  for (size_t i = 0; i < noise.size(); ++i)
    noise[i] = static_cast<float>(i * i * 2654435761u % 1000003u) / 1000003.0f;
  for (const char* name : {"a.exr", "a.png"})
    EXPECT_THAT(error_of<InputError>([&] { write_height_map(disk / name, noise, Provenance::object()); }),
                EndsWith(std::string(name) + ": could not write: No space left on device"));
  EXPECT_EQ(disk.count(), 0u);
}

TEST(ImageIoCancel, LeavesNothing) {
  const TemporaryFolder folder;
  write_height_map(folder / "a.exr", Grid<float>(64, 64), Provenance::object());
  const std::atomic<bool> cancel = true;
  Context context;
  context.cancel = &cancel;
  const ContextScope scope(context);
  EXPECT_THROW(read_height_map(folder / "a.exr"), Cancelled);
  for (const char* name : {"b.exr", "b.png"})
    EXPECT_THROW(write_height_map(folder / name, Grid<float>(64, 64), Provenance::object()), Cancelled);
  EXPECT_EQ(folder.count(), 1u);
}

}  // namespace
}  // namespace hemibake
