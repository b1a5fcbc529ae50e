// PNGs whose chunks lie, built byte by byte.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <zlib.h>

#include <cstdint>

#include "io/compress.h"
#include "io/foreign_images.h"

namespace hemibake {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

std::string big_endian(uint32_t value) {
  return {static_cast<char>(value >> 24), static_cast<char>(value >> 16), static_cast<char>(value >> 8),
          static_cast<char>(value)};
}

std::string chunk(const std::string& type, const std::string& data) {
  const std::string body = type + data;
  const uLong crc = crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
  return big_endian(static_cast<uint32_t>(data.size())) + body + big_endian(static_cast<uint32_t>(crc));
}

// 8 bits of grey.
std::string head(uint32_t width, uint32_t height) {
  return "\x89PNG\r\n\x1a\n" +
         chunk("IHDR", big_endian(width) + big_endian(height) + std::string("\x08\0\0\0\0", 5));
}

std::string texels(const std::string& rows) {
  return deflate_bytes({reinterpret_cast<const uint8_t*>(rows.data()), rows.size()});
}

class PngCheck : public ImageIo {
 protected:
  void expect_refused(const std::string& bytes, const std::string& reason) {
    write_bytes(folder_ / "a.png", bytes);
    testing::internal::CaptureStderr();
    EXPECT_THAT(refusal("a.png"), AllOf(HasSubstr("a.png: " + reason), HasSubstr("expected"))) << reason;
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  }

  const std::string rows_ = texels(std::string("\0\x33\xff\0\xff\x33", 6));
  const std::string end_ = chunk("IEND", "");
};

TEST_F(PngCheck, TakesAWholeOne) {
  write_bytes(folder_ / "a.png",
              head(2, 2) + chunk("tEXt", std::string("a\0b", 3)) + chunk("IDAT", rows_) + end_);
  EXPECT_THAT(read_height_map(folder_ / "a.png").values, ElementsAre(0.2f, 1, 1, 0.2f));
}

TEST_F(PngCheck, RefusesAnyWrongCrc) {
  const std::string chunks[] = {head(2, 2), chunk("tEXt", std::string("a\0b", 3)), chunk("IDAT", rows_),
                                end_};
  for (size_t wrong = 0; wrong < 4; ++wrong) {
    std::string bytes;
    for (size_t c = 0; c < 4; ++c) {
      bytes += chunks[c];
      if (c == wrong) bytes.back() ^= 1;
    }
    expect_refused(bytes, "is damaged (a CRC does not fit)");
  }
}

TEST_F(PngCheck, RefusesChunksOutOfPlace) {
  const std::string fault = "is damaged (a chunk that does not belong there)";
  const std::string data = chunk("IDAT", rows_.substr(0, 5)), more = chunk("IDAT", rows_.substr(5));
  expect_refused(head(2, 2) + chunk("ABCD", "") + data + more + end_, fault);
  expect_refused(head(2, 2) + data + chunk("tEXt", "a") + more + end_, fault);
  expect_refused(head(2, 2) + chunk("PLTE", std::string(3 * 257, 'x')) + data + more + end_, fault);
  expect_refused(head(2, 2) + chunk("PLTE", "1234") + data + more + end_, fault);
  expect_refused(head(2, 2) + head(2, 2).substr(8) + data + more + end_, fault);
}

TEST_F(PngCheck, RefusesHeadersThatClaimTooMuch) {
  const std::string rest = chunk("IDAT", rows_) + end_;
  expect_refused(head(65536, 65536) + rest, "claims 65536 x 65536 texels");
  expect_refused(head(0x7fffffff, 1) + rest, "claims 2147483647 x 1 texels");
  for (const uint32_t side : {0u, 0x80000000u, 0xffffffffu})
    expect_refused(head(side, 2) + rest, "has a damaged header");
  expect_refused(head(2, 3) + rest, "is damaged or cut short near row 2");
  expect_refused(head(16384, 16384) + rest, "is damaged or cut short near row 0");
}

TEST_F(PngCheck, RefusesTexelsThatAreNone) {
  expect_refused(head(2, 2) + chunk("IDAT", "no zlib") + end_, "is damaged or cut short near row 0");
  expect_refused(head(2, 2) + chunk("IDAT", texels("\x07\x33\xff\x07\xff\x33")) + end_,
                 "is damaged or cut short near row");
  expect_refused(head(2, 2) + end_, "is damaged or cut short near row 0");
  const std::string whole = head(2, 2) + chunk("IDAT", rows_) + end_;
  for (size_t length = 8; length < whole.size(); ++length) expect_refused(whole.substr(0, length), "is ");
}

// 256 MiB of zeros behind four texels: they are neither held nor read.
TEST_F(PngCheck, WhatInflatesBeyondTheTexelsIsLeft) {
  std::string rows("\0\x33\xff\0\xff\x33", 6);
  rows.resize(size_t{256} << 20);
  write_bytes(folder_ / "a.png", head(2, 2) + chunk("IDAT", texels(rows)) + end_);
  rows = {};
  testing::internal::CaptureStderr();
  EXPECT_THAT(read_height_map(folder_ / "a.png").values, ElementsAre(0.2f, 1, 1, 0.2f));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace hemibake
