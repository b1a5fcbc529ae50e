#include "core/printable.h"

#include <gtest/gtest.h>

#include <random>

namespace hemibake {
namespace {

TEST(Printable, OrdinaryTextStays) {
  for (const char* text : {"", "bricks.png", "Straße, 高さ, \xF0\x9F\x8C\x8D", "a\tb\nc\n", "α ≤ V"})
    EXPECT_EQ(printable_text(text), text);
  EXPECT_EQ(printable_line("a\tb\r\nc"), "a b  c");
}

TEST(Printable, NoEscapeSequencePasses) {
  EXPECT_EQ(printable_text("\x1b[31mred\x07"), "\uFFFD[31mred\uFFFD");
  EXPECT_EQ(printable_text("\xC2\x9B"
                           "31m"),
            "\uFFFD31m");
  EXPECT_EQ(printable_text("\x9b"
                           "31m\x7f"),
            "\uFFFD31m\uFFFD");
  EXPECT_EQ(printable_text(std::string_view("a\0b", 3)), "a\uFFFDb");
  EXPECT_EQ(printable_text("gnp.\u202Egnp\u2028"), "gnp.\uFFFDgnp\uFFFD");
  EXPECT_EQ(printable_text("a\rb"), "a\uFFFDb");
}

TEST(Printable, WhatIsNoUtf8IsReplaced) {
  EXPECT_EQ(printable_text("map \xff.png"), "map \uFFFD.png");
  EXPECT_EQ(printable_text("\xC0\x9B"), "\uFFFD\uFFFD");            // longer than needed
  EXPECT_EQ(printable_text("\xED\xA0\x80"), "\uFFFD\uFFFD\uFFFD");  // half of a pair
  EXPECT_EQ(printable_text("\xF4\x90\x80\x80"), "\uFFFD\uFFFD\uFFFD\uFFFD");
  EXPECT_EQ(printable_text("\xE2\x82"), "\uFFFD\uFFFD");  // cut short
}

TEST(Printable, AnyBytesBecomeTextThatStays) {
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    std::string bytes(random() % 12, ' ');
    for (char& byte : bytes) byte = static_cast<char>(random());
    const std::string text = printable_text(bytes);
    EXPECT_EQ(printable_text(text), text);
    EXPECT_EQ(text.find('\x1b'), std::string::npos);
    EXPECT_EQ(printable_line(bytes).find('\n'), std::string::npos);
  }
}

TEST(Printable, ExcerptsAreShortAndWhole) {
  EXPECT_EQ(excerpt("short"), "short");
  EXPECT_EQ(excerpt("αβγδ", 5), "αβ…");
  EXPECT_EQ(excerpt(std::string(1000, 'x'), 4), "xxxx…");
  EXPECT_EQ(excerpt(std::string(10, '\x80'), 4), "…");
}

}  // namespace
}  // namespace hemibake
