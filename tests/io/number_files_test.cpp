// Heights of files without an image format: raw numbers and NumPy arrays.
#include <gmock/gmock.h>

#include <cmath>

#include "io/height_files.h"

namespace hemibake {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;

TEST_F(HeightFiles, RawOfEveryType) {
  const auto expect = [&](const std::string& type, const std::string& bytes, std::vector<float> values,
                          double full_scale) {
    write_bytes(folder_ / "a.raw", bytes);
    const HeightFile file = read("a.raw", raw("3x1:" + type));
    EXPECT_EQ(file.values.values, values) << type;
    EXPECT_EQ(file.full_scale, full_scale) << type;
    EXPECT_EQ(file.format, "raw");
    EXPECT_FALSE(file.in_metres);
  };
  expect("u8", bytes_of<uint8_t>({0, 51, 255}), {0, 0.2f, 1}, 255);
  expect("i8", bytes_of<int8_t>({-128, 5, 127}), {-128, 5, 127}, 1);
  for (const bool big : {false, true}) {
    const std::string end = big ? "be" : "le";
    expect("u16" + end, bytes_of<uint16_t>({0, 13107, 65535}, big), {0, 0.2f, 1}, 65535);
    expect("i16" + end, bytes_of<int16_t>({-430, 5, 8848}, big), {-430, 5, 8848}, 1);
    expect("u32" + end, bytes_of<uint32_t>({0, 858993459, 4294967295}, big), {0, 0.2f, 1}, 4294967295);
    expect("i32" + end, bytes_of<int32_t>({-430, 5, 8848}, big), {-430, 5, 8848}, 1);
    expect("f16" + end, bytes_of<uint16_t>({0x3c00, 0xb555, 0x0001}, big),
           {1, -0.333251953125f, 5.9604644775390625e-8f}, 1);
    expect("f32" + end, bytes_of<float>({-430.5f, 0.1f, 8848}, big), {-430.5f, 0.1f, 8848}, 1);
    expect("f64" + end, bytes_of<double>({-430.5, 0.1, 8848}, big), {-430.5f, 0.1f, 8848}, 1);
  }
}

TEST_F(HeightFiles, RawRefusalsSayWhatFits) {
  write_bytes(folder_ / "a.r16", std::string(512 * 512 * 2, 'x'));
  EXPECT_THAT(fault("a.r16"),
              EndsWith("a.r16: has no header, expected --raw WxH:TYPE; it has 524288 bytes, as "
                       "--raw 512x512:u16le has"));
  EXPECT_THAT(fault("a.r16", raw("512x512:f32le")),
              HasSubstr("has 524288 bytes, expected 1048576 of --raw 512x512:f32le; it has 524288 bytes, as "
                        "--raw 512x512:u16le has"));
  write_bytes(folder_ / "b.RAW", std::string(64 * 64, 'x'));
  EXPECT_THAT(fault("b.RAW"), EndsWith("as --raw 64x64:u8 or 32x32:f32le has"));
  write_bytes(folder_ / "c.raw", std::string(7, 'x'));
  EXPECT_THAT(fault("c.raw"), EndsWith("it has 7 bytes, which no square of u8, u16le, f32le texels fills"));
  for (const char* bad : {"7x1", "x1:u8", "7x:u8", "7x1:u16", "7x1:u8le", "7,1:u8", "-7x1:u8", "0x1:u8",
                          "7x1:u9", "7x1:le", "7x1:u8 ", "99999999999x1:u8"})
    EXPECT_THAT(fault("c.raw", raw(bad)), HasSubstr("expected WIDTHxHEIGHT:TYPE as 512x512:u16le")) << bad;
  EXPECT_THAT(fault("c.raw", raw("99999x99999:u8")), HasSubstr("texels, expected at most"));
  EXPECT_THAT(fault("missing.raw", raw("7x1:u8")), HasSubstr("No such file"));
}

std::string npy(const std::string& descr, const std::string& order, const std::string& shape,
                const std::string& data, int version = 1) {
  std::string header = "{'descr': " + descr + ", 'fortran_order': " + order + ", 'shape': " + shape + ", }\n";
  std::string bytes = "\x93NUMPY";
  bytes += static_cast<char>(version);
  bytes += '\0';
  const auto length = static_cast<uint32_t>(header.size());
  bytes += bytes_of<uint32_t>({length}).substr(0, version == 1 ? 2 : 4);
  return bytes + header + data;
}

TEST_F(HeightFiles, NpyOfEveryForm) {
  const std::string rows = bytes_of<float>({1, 2, 3, 4, 5, 6}), columns = bytes_of<float>({1, 4, 2, 5, 3, 6});
  const auto expect = [&](const std::string& bytes) {
    write_bytes(folder_ / "a.npy", bytes);
    const HeightFile file = read("a.npy");
    EXPECT_EQ(file.format, "NumPy");
    EXPECT_EQ(file.values.width, 3);
    EXPECT_THAT(file.values.values, ElementsAre(1, 2, 3, 4, 5, 6));
    EXPECT_EQ(file.full_scale, 1);
  };
  for (const int version : {1, 2, 3}) expect(npy("'<f4'", "False", "(2, 3)", rows, version));
  expect(npy("'<f4'", "True", "(2, 3)", columns));
  expect(npy("'<f4'", "False", "(2, 3, 1)", rows));
  expect(npy("'>f4'", "False", "(2, 3)", bytes_of<float>({1, 2, 3, 4, 5, 6}, true)));
  expect(npy("'<f8'", "False", "(2, 3)", bytes_of<double>({1, 2, 3, 4, 5, 6})));
  expect(npy("'<i2'", "False", "(2, 3)", bytes_of<int16_t>({1, 2, 3, 4, 5, 6})));
  expect(npy("'>i4'", "False", "(2, 3)", bytes_of<int32_t>({1, 2, 3, 4, 5, 6}, true)));
  expect(npy("'|i1'", "False", "(2, 3)", bytes_of<int8_t>({1, 2, 3, 4, 5, 6})));
  expect(
      npy("'<f2'", "False", "(2, 3)", bytes_of<uint16_t>({0x3c00, 0x4000, 0x4200, 0x4400, 0x4500, 0x4600})));
  write_bytes(folder_ / "u.npy", npy("'<u2'", "False", "(1, 2)", bytes_of<uint16_t>({13107, 65535})));
  EXPECT_THAT(read("u.npy").values.values, ElementsAre(0.2f, 1));
  write_bytes(folder_ / "b.npy", npy("'|u1'", "False", "(2, 1)", "\x33\xff"));
  EXPECT_THAT(read("b.npy").values.values, ElementsAre(0.2f, 1));
}

TEST_F(HeightFiles, BrokenNpyIsRefused) {
  const std::string two = bytes_of<float>({1, 2});
  const auto expect = [&](const std::string& bytes, const char* reason) {
    write_bytes(folder_ / "b.npy", bytes);
    EXPECT_THAT(fault("b.npy"), AllOf(HasSubstr("b.npy: "), HasSubstr(reason))) << reason;
  };
  expect(npy("'<f4'", "False", "(2,)", two), "is an array of shape (2,), expected rows and columns");
  expect(npy("'<f4'", "False", "(1, 1, 2)", two), "is an array of shape (1, 1, 2)");
  expect(npy("'<f4'", "False", "(1,\n2, 2)", two), "is an array of shape (1, 2, 2), expected");
  expect(npy("'<f4'", "False", "(0, 2)", ""), "is an array of 0 x 2 numbers");
  expect(npy("'<f4'", "False", "(99999999999, 99999999999)", two), "expected 1 to");
  expect(npy("'<f4'", "False", "(1, 3)", two), "has 8 bytes of numbers, expected 12 of 3 x 1 32-bit floats");
  for (const char* shape : {"()", "(1, 2", "(-1, 2)", "(1.5, 2)", "('a', 2)", "[1, 2]", "(1, 2, 3, 4)",
                            "(99999999999999999999, 1)", ""})
    expect(npy("'<f4'", "False", shape, two), "expected rows and columns");
  expect(npy("'<f4'", "False", "(16384, 16384)", two), "has 8 bytes of numbers");
  expect(npy("'<f4'", "False", "(1, 2)", two + "x"), "has 9 bytes of numbers, expected 8");
  expect(npy("'<c8'", "False", "(1, 1)", two), "holds numbers of type '<c8'");
  expect(npy("'|b1'", "False", "(1, 1)", "x"), "holds numbers of type '|b1'");
  expect(npy("[('a', '<f4')]", "False", "(1, 2)", two), "holds numbers of type ");
  expect(npy("'<f4'", "False", "(1, 2)", two, 9), "is of version 9");
  const std::string whole = npy("'<f4'", "False", "(1, 2)", two);
  for (size_t length = 6; length < whole.size(); ++length) expect(whole.substr(0, length), "expected");
  expect(npy("'<f4'", "False", "(1, 2)", bytes_of<float>({1, INFINITY})), "height is inf at texel 1,0");
}

}  // namespace
}  // namespace hemibake
