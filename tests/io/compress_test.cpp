#include "io/compress.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <vector>

namespace hemibake {
namespace {

// RFC 4648, section 10.
TEST(Compress, Base64OfTheStandard) {
  const std::vector<std::pair<std::string, std::string>> vectors = {{"", ""},
                                                                    {"f", "Zg=="},
                                                                    {"fo", "Zm8="},
                                                                    {"foo", "Zm9v"},
                                                                    {"foob", "Zm9vYg=="},
                                                                    {"fooba", "Zm9vYmE="},
                                                                    {"foobar", "Zm9vYmFy"},
                                                                    {"\xfb\xff\xfe", "+//+"}};
  for (const auto& [bytes, text] : vectors) EXPECT_EQ(base64(bytes), text);
}

TEST(Compress, DeflatedBytesComeBack) {
  for (const size_t size : {0U, 1U, 70000U}) {
    std::vector<uint8_t> bytes(size);
    for (size_t i = 0; i < size; ++i) bytes[i] = static_cast<uint8_t>(i * i / 7);
    const std::string stream = deflate_bytes(bytes);
    std::vector<uint8_t> back(size + 1);
    uLongf length = back.size();
    ASSERT_EQ(uncompress(back.data(), &length, reinterpret_cast<const Bytef*>(stream.data()), stream.size()),
              Z_OK);
    back.resize(length);
    EXPECT_EQ(back, bytes);
  }
}

}  // namespace
}  // namespace hemibake
