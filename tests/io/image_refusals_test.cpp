// What the image reader refuses, each kind of bad input by itself.
#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/memory_limit.h"
#include "io/foreign_images.h"

namespace hemibake {
namespace {

using testing::AnyOf;
using testing::EndsWith;
using testing::HasSubstr;

using ImageRefusals = ImageIo;

TEST_F(ImageRefusals, RefusesWhatIsNoImage) {
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

TEST_F(ImageRefusals, RefusesValuesThatAreNotFinite) {
  for (const float bad : {NAN, INFINITY, -INFINITY}) {
    std::vector<float> values(3 * 5 * 100, 0.5f);
    values[3 * (5 * 71 + 4) + 1] = bad;
    for (const char* name : {"bad.exr", "bad.tif"}) {
      write_foreign(folder_ / name, spec_of(5, 100, {"R", "G", "B"}), values);
      EXPECT_THAT(refusal(name),
                  AllOf(HasSubstr("bad."), HasSubstr("channel G is "), HasSubstr("at texel 4,71")));
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

TEST_F(ImageRefusals, RefusesFilesCutShort) {
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

TEST_F(ImageRefusals, RefusesTiffsThatOpenImageIoMisreads) {
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

TEST_F(ImageRefusals, RefusesADamagedPng) {
  write_foreign(folder_ / "a.png", spec_of(100, 100, {"Y"}), std::vector<uint8_t>(10000, 77));
  std::string bytes = read_bytes(folder_ / "a.png");
  bytes[bytes.find("IDAT") + 20] ^= 0x55;
  write_bytes(folder_ / "damaged.png", bytes);
  EXPECT_THAT(refusal("damaged.png"), HasSubstr("damaged.png: is damaged (a CRC does not fit)"));
}

TEST_F(ImageRefusals, OpensOnlyWhatItsContentSays) {
  using namespace std::string_literals;
  const std::string rest(100, 'x');
  for (const auto& [begin, name] : {std::pair{"GIF89a"s, "a GIF"}, std::pair{"SDPX"s, "a DPX"},
                                    std::pair{"\x01\xDA"s, "an SGI"}, std::pair{"FOR4"s, "a Maya IFF"}}) {
    write_bytes(folder_ / "x.png", begin + rest);
    EXPECT_THAT(refusal("x.png"),
                AllOf(HasSubstr(name), HasSubstr("which is not read"), HasSubstr("convert")));
  }
  write_foreign(folder_ / "a.png", spec_of(3, 2, {"Y"}), std::vector<uint8_t>(6, 7));
  std::filesystem::rename(folder_ / "a.png", folder_ / "a.exr");
  EXPECT_NO_THROW(read_height_map(folder_ / "a.exr"));
}

TEST_F(ImageRefusals, CountsMemoryBeforeTexels) {
  const MemoryScope half_gib(0.5);
  write_foreign(folder_ / "a.png", spec_of(12000, 12000, {"Y"}), std::vector<uint8_t>(144000000));
  EXPECT_THAT(refusal("a.png"), HasSubstr("a.png: has 12000 x 12000 texels, which need"));
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

TEST_F(ImageRefusals, RefusesHugePngBeforeAllocating) {
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

TEST_F(ImageRefusals, RefusesHugeExrBeforeAllocating) {
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

TEST_F(ImageRefusals, RefusesHugeTiffBeforeAllocating) {
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

TEST_F(ImageRefusals, RefusesSeveralImages) {
  write_foreign(folder_ / "pages.tif", spec_of(2, 2, {"Y"}), std::vector<uint8_t>(4), 2);
  EXPECT_THAT(refusal("pages.tif"), EndsWith("pages.tif: holds 2 images, expected one"));
  write_foreign(folder_ / "parts.exr", spec_of(2, 2, {"Y"}), std::vector<float>(4), 2);
  EXPECT_THAT(refusal("parts.exr"), EndsWith("parts.exr: holds 2 images, expected one"));
}

TEST_F(ImageRefusals, RefusesDeepImages) {
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

TEST_F(ImageRefusals, RefusesCroppedExr) {
  OIIO::ImageSpec spec = spec_of(2, 2, {"Y"});
  spec.x = 1;
  spec.full_width = spec.full_height = 4;
  write_foreign(folder_ / "crop.exr", spec, std::vector<float>(4));
  EXPECT_THAT(refusal("crop.exr"),
              HasSubstr("data window of 2 x 2 at (1, 0) in a display window of 4 x 4 at (0, 0)"));
}

// The library sets aside what the header claims when it opens run lengths.
TEST_F(ImageRefusals, RefusesABmpOfRunsThatClaimsMoreThanItHolds) {
  const auto number = [](uint32_t value) {
    std::string bytes;
    for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift);
    return bytes;
  };
  std::string bmp = "BM" + number(60) + number(0) + number(54) + number(40) + number(16000) + number(16000);
  bmp += std::string("\1\0\x08\0", 4) + number(1);  // a plane of 8 bits in run lengths
  bmp.resize(60);
  write_bytes(folder_ / "runs.bmp", bmp);
  EXPECT_THAT(refusal("runs.bmp"), HasSubstr("claims 16000 x 16000 texels and has only 60 bytes"));
}

}  // namespace
}  // namespace hemibake
