// TGAs with palettes, built byte by byte.
#include "io/targa_check.h"

#include <gmock/gmock.h>

#include "io/io_testing.h"

namespace hemibake {
namespace {

using testing::HasSubstr;

// 2 x 2 texels with a palette of two colours. kind: 1 or 9.
std::string targa(char kind, const std::string& texels) {
  return std::string("\0\1", 2) + kind + std::string("\0\0\2\0\x18\0\0\0\0\2\0\2\0\x08\0", 15) +
         std::string("\0\0\0\xff\xff\xff", 6) + texels;
}

std::string fault_of(const std::string& bytes) {
  const TemporaryFolder folder;
  write_bytes(folder / "a.tga", bytes);
  return targa_error(folder / "a.tga");
}

TEST(TargaCheck, IndicesStayInThePalette) {
  EXPECT_EQ(fault_of(targa(1, std::string("\0\1\1\0", 4))), "");
  EXPECT_EQ(fault_of(targa(9, std::string("\x81\0\1\1\0", 5))), "");
  EXPECT_THAT(fault_of(targa(1, std::string("\0\1\2\0", 4))),
              HasSubstr("has a texel of colour 2, expected 0 to 1"));
  EXPECT_THAT(fault_of(targa(9, "\x83\xff")), HasSubstr("has a texel of colour 255"));
}

TEST(TargaCheck, IsWhole) {
  EXPECT_THAT(fault_of(targa(1, std::string("\0\1\1", 3))), HasSubstr("is cut short"));
  EXPECT_THAT(fault_of(targa(9, std::string("\x80\0", 2))), HasSubstr("is cut short"));
  EXPECT_THAT(fault_of("short"), HasSubstr("is cut short"));
}

// Grey and true colours have no palette to leave.
TEST(TargaCheck, OthersAreLeftAlone) { EXPECT_EQ(fault_of(targa(3, "\xff")), ""); }

}  // namespace
}  // namespace hemibake
