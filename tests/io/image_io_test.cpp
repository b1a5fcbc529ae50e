#include "io/image_io.h"

#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>

#include "core/interrupt.h"
#include "io/io_testing.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;
using testing::AnyOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

// Writes an image as some other program would: values interleaved, stored as T unless the
// spec says half floats, several of the same where `images`
// > 1.
template <class T>
void write_foreign(const fs::path& path, OIIO::ImageSpec spec, const std::vector<T>& values, int images = 1) {
  if (spec.format != OIIO::TypeDesc::HALF) spec.set_format(OIIO::BaseTypeFromC<T>::value);
  const auto output = OIIO::ImageOutput::create(path.string());
  ASSERT_TRUE(output) << OIIO::geterror();
  for (int i = 0; i < images; ++i) {
    if (images > 1 && i == 0 && output->supports("multiimage") && path.extension() == ".exr") {
      std::vector<OIIO::ImageSpec> specs(static_cast<size_t>(images), spec);
      for (size_t k = 0; k < specs.size(); ++k)
        specs[k].attribute("oiio:subimagename", fmt::format("part {}", k));
      ASSERT_TRUE(output->open(path.string(), images, specs.data())) << output->geterror();
    } else {
      const auto mode = i == 0 ? OIIO::ImageOutput::Create : OIIO::ImageOutput::AppendSubimage;
      ASSERT_TRUE(output->open(path.string(), spec, mode)) << output->geterror();
    }
    ASSERT_TRUE(output->write_image(OIIO::BaseTypeFromC<T>::value, values.data())) << output->geterror();
  }
  ASSERT_TRUE(output->close());
}

OIIO::ImageSpec spec_of(int width, int height, const std::vector<std::string>& channels) {
  OIIO::ImageSpec spec(width, height, static_cast<int>(channels.size()), OIIO::TypeDesc::UINT8);
  spec.channelnames = channels;
  const auto alpha = std::find(channels.begin(), channels.end(), "A");
  if (alpha != channels.end()) spec.alpha_channel = static_cast<int>(alpha - channels.begin());
  return spec;
}

class ImageIo : public testing::Test {
 protected:
  std::string refusal(const std::string& name, const std::string& channel = "") {
    return error_of<InputError>([&] { read_height_map(folder_ / name, channel); });
  }

  TemporaryFolder folder_;
};

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
    EXPECT_EQ(read_normal_map(folder_ / name, 2, 1)[1].y, expected) << name;
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
  const Grid<glm::vec3> normals = read_normal_map(folder_ / "n.png", 2, 1);
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

// ---- Bad input, each kind by itself

TEST_F(ImageIo, RefusesWhatIsNoImage) {
  EXPECT_THAT(refusal("missing.png"), EndsWith("missing.png: No such file or directory, expected an image"));
  EXPECT_THAT(refusal(""), EndsWith("is a folder, expected an image"));
  write_bytes(folder_ / "empty.png", "");
  EXPECT_THAT(refusal("empty.png"), EndsWith("empty.png: is empty, expected an image"));
  for (const char* name : {"text.png", "text.exr", "text.tif", "text.jpg", "text.xyz", "text"}) {
    write_bytes(folder_ / name, "This is no image, whatever it is called.");
    EXPECT_THAT(refusal(name), HasSubstr(std::string(name) + ": is not an image that can be read"));
  }
  EXPECT_THAT(error_of<InputError>([] { read_height_map("/dev/zero"); }), HasSubstr("is not a regular file"));
}

TEST_F(ImageIo, RefusesValuesThatAreNotFinite) {
  for (const float bad : {NAN, INFINITY, -INFINITY}) {
    std::vector<float> values(3 * 5 * 100, 0.5f);
    values[3 * (5 * 71 + 4) + 1] = bad;
    for (const char* name : {"bad.exr", "bad.tif"}) {
      write_foreign(folder_ / name, spec_of(5, 100, {"R", "G", "B"}), values);
      EXPECT_THAT(refusal(name),
                  AllOf(HasSubstr("bad."), HasSubstr("channel G is "), HasSubstr("at texel (4, 71)")));
      EXPECT_EQ(read_height_map(folder_ / name, "R")[0], 0.5f);  // the bad channel was not asked for
    }
  }
}

// Some lengths to cut a file to: everywhere in the header, in the data and at the very end.
std::vector<size_t> cuts(size_t size) {
  std::vector<size_t> lengths{1,        4,        8,          16,        33,        60,      200,
                              size / 4, size / 2, size - 100, size - 20, size - 12, size - 1};
  lengths.erase(std::remove_if(lengths.begin(), lengths.end(), [&](size_t length) { return length >= size; }),
                lengths.end());
  return lengths;
}

TEST_F(ImageIo, RefusesFilesCutShort) {
  std::vector<uint16_t> values(100 * 100 * 3);
  std::vector<float> floats(values.size());
  for (size_t i = 0; i < values.size(); ++i) {
    values[i] = static_cast<uint16_t>(i * 40503);
    floats[i] = static_cast<float>(values[i]);
  }
  const OIIO::ImageSpec spec = spec_of(100, 100, {"R", "G", "B"});
  OIIO::ImageSpec lzw = spec;
  lzw.attribute("compression", "lzw");
  OIIO::ImageSpec tiled = spec;
  tiled.tile_width = tiled.tile_height = 32;
  write_foreign(folder_ / "a.png", spec, values);
  write_foreign(folder_ / "a.tif", spec, values);
  write_foreign(folder_ / "lzw.tif", lzw, values);
  write_foreign(folder_ / "a.exr", spec, floats);
  write_foreign(folder_ / "tiled.exr", tiled, floats);
  write_foreign(folder_ / "tiled.tif", tiled, values);
  for (const std::string name : {"a.png", "a.tif", "lzw.tif", "a.exr", "tiled.exr", "tiled.tif"}) {
    ASSERT_NO_THROW(read_height_map(folder_ / name));
    const std::string bytes = read_bytes(folder_ / name);
    for (const size_t length : cuts(bytes.size())) {
      write_bytes(folder_ / ("cut-" + name), bytes.substr(0, length));
      EXPECT_THAT(refusal("cut-" + name), HasSubstr("cut-" + name + ": "))
          << length << " of " << bytes.size();
    }
  }
}

TEST_F(ImageIo, RefusesTiffsThatOpenImageIoMisreads) {
  // Zeros come out, in some rows or in all of them.
  write_foreign(folder_ / "double.tif", spec_of(3, 65, {"Y"}), std::vector<double>(195, 0.5));
  EXPECT_THAT(refusal("double.tif"),
              EndsWith("double.tif: holds 64-bit floats, which cannot be read, expected 32-bit floats"));
  // The values come out upside down.
  write_foreign(folder_ / "white.tif", spec_of(2, 2, {"Y"}), std::vector<uint16_t>(4, 7));
  std::string bytes = read_bytes(folder_ / "white.tif");
  using namespace std::string_literals;
  const std::string black_is_zero = "\x06\x01\x03\0\x01\0\0\0\x01\0"s;
  ASSERT_NE(bytes.find(black_is_zero), std::string::npos);
  bytes[bytes.find(black_is_zero) + 8] = 0;
  write_bytes(folder_ / "white.tif", bytes);
  EXPECT_THAT(refusal("white.tif"), HasSubstr("white.tif: stores white as the least value"));
}

TEST_F(ImageIo, RefusesADamagedPng) {
  write_foreign(folder_ / "a.png", spec_of(100, 100, {"Y"}), std::vector<uint8_t>(10000, 77));
  std::string bytes = read_bytes(folder_ / "a.png");
  bytes[bytes.find("IDAT") + 20] ^= 0x55;
  write_bytes(folder_ / "damaged.png", bytes);
  EXPECT_THAT(refusal("damaged.png"), HasSubstr("damaged.png: is damaged (a CRC does not fit)"));
}

// ---- Claims in the header

uint32_t png_crc(const std::string& bytes) {
  uint32_t crc = ~0u;
  for (const char c : bytes) {
    crc ^= static_cast<uint8_t>(c);
    for (int k = 0; k < 8; ++k) crc = (crc >> 1) ^ (0xEDB88320u & (0u - (crc & 1u)));
  }
  return ~crc;
}

std::string big_endian(uint32_t value) {
  return {static_cast<char>(value >> 24), static_cast<char>(value >> 16), static_cast<char>(value >> 8),
          static_cast<char>(value)};
}

TEST_F(ImageIo, RefusesHugePngBeforeAllocating) {
  for (const uint32_t side : {16385u, 100000u, 0x7fffffffu}) {
    const std::string header = "IHDR" + big_endian(side) + big_endian(side) + std::string("\x10\0\0\0\0", 5);
    const std::string data = "IDAT";
    write_bytes(folder_ / "huge.png", "\x89PNG\r\n\x1a\n" + big_endian(13) + header +
                                          big_endian(png_crc(header)) + big_endian(0) + data +
                                          big_endian(png_crc(data)));
    EXPECT_THAT(refusal("huge.png"),
                AnyOf(HasSubstr("texels, expected at most 268435456"), HasSubstr("not an image")));
  }
}

TEST_F(ImageIo, RefusesHugeExrBeforeAllocating) {
  write_height_map(folder_ / "small.exr", Grid<float>(4, 4), Provenance::object());
  std::string bytes = read_bytes(folder_ / "small.exr");
  const std::array<int32_t, 4> window{0, 0, 99999, 99999};
  using namespace std::string_literals;
  for (const std::string& name : {"dataWindow\0box2i\0"s, "displayWindow\0box2i\0"s})
    std::memcpy(&bytes[bytes.find(name) + name.size() + 4], window.data(), sizeof(window));
  write_bytes(folder_ / "huge.exr", bytes);
  EXPECT_THAT(refusal("huge.exr"),
              AnyOf(HasSubstr("claims 100000 x 100000 texels, expected at most 268435456"),
                    HasSubstr("not an image")));
}

TEST_F(ImageIo, RefusesHugeTiffBeforeAllocating) {
  write_foreign(folder_ / "huge.tif", spec_of(0x1234, 2, {"Y"}), std::vector<uint8_t>(2 * 0x1234));
  std::string bytes = read_bytes(folder_ / "huge.tif");
  using namespace std::string_literals;
  const auto set_long = [&](const std::string& tag) {
    const size_t at = bytes.find(tag + "\x03\0\1\0\0\0"s);
    ASSERT_NE(at, std::string::npos);
    bytes.replace(at, 12, tag + "\x04\0\1\0\0\0\xa0\x86\1\0"s);  // 100000
  };
  set_long("\0\1"s);
  set_long("\1\1"s);
  write_bytes(folder_ / "huge.tif", bytes);
  EXPECT_THAT(refusal("huge.tif"), HasSubstr("claims 100000 x 100000 texels"));
}

TEST_F(ImageIo, RefusesSeveralImages) {
  write_foreign(folder_ / "pages.tif", spec_of(2, 2, {"Y"}), std::vector<uint8_t>(4), 2);
  EXPECT_THAT(refusal("pages.tif"), EndsWith("pages.tif: holds several images, expected one"));
  write_foreign(folder_ / "parts.exr", spec_of(2, 2, {"Y"}), std::vector<float>(4), 2);
  EXPECT_THAT(refusal("parts.exr"), EndsWith("parts.exr: holds several images, expected one"));
}

TEST_F(ImageIo, RefusesDeepImages) {
  OIIO::ImageSpec spec = spec_of(2, 2, {"A", "Z"});
  spec.set_format(OIIO::TypeDesc::FLOAT);
  spec.deep = true;
  OIIO::DeepData deep;
  deep.init(spec);
  const auto output = OIIO::ImageOutput::create("openexr");
  ASSERT_TRUE(output->open((folder_ / "deep.exr").string(), spec) && output->write_deep_image(deep));
  output->close();
  EXPECT_THAT(refusal("deep.exr", "Z"), HasSubstr("deep.exr: is a deep image"));
}

TEST_F(ImageIo, RefusesCroppedExr) {
  OIIO::ImageSpec spec = spec_of(2, 2, {"Y"});
  spec.x = 1;
  spec.full_width = spec.full_height = 4;
  write_foreign(folder_ / "crop.exr", spec, std::vector<float>(4));
  EXPECT_THAT(refusal("crop.exr"),
              HasSubstr("data window of 2 x 2 at (1, 0) in a display window of 4 x 4 at (0, 0)"));
}

// ---- Writing

TEST_F(ImageIo, PngRefusesWhatItCannotHold) {
  for (const float bad : {-0.001f, 1.001f}) {
    Grid<float> heights(3, 2, 0.5f);
    heights(2, 1) = bad;
    EXPECT_THAT(
        error_of<InputError>([&] { write_height_map(folder_ / "a.png", heights, Provenance::object()); }),
        AllOf(HasSubstr("a.png: channel Y is "), HasSubstr("at texel (2, 1), expected 0..1 in a PNG")));
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
  const Grid<glm::vec3> read = read_normal_map(folder_ / "p.png", 2, 1);
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

// In a child process: the signal's mark stays.
[[noreturn]] void interrupt_reading_and_writing() {
  const TemporaryFolder folder;
  write_height_map(folder / "a.exr", Grid<float>(64, 64), Provenance::object());
  install_signal_handlers();
  std::raise(SIGINT);
  int interrupted = 0;
  const auto attempt = [&](const auto& action) {
    try {
      action();
    } catch (const Interrupted&) {
      ++interrupted;
    }
  };
  attempt([&] { read_height_map(folder / "a.exr"); });
  for (const char* name : {"b.exr", "b.png"})
    attempt([&] { write_height_map(folder / name, Grid<float>(64, 64), Provenance::object()); });
  const bool clean = interrupted == 3 && folder.count() == 1;
  fs::remove_all(folder.path());
  std::exit(clean ? 0 : 1);
}

TEST(ImageIoDeathTest, InterruptLeavesNothing) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(interrupt_reading_and_writing(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace hemibake
