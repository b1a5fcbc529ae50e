// Values as people type them, and as they should not.
#include "core/field.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace hemibake {
namespace {

std::string complaint(const Value& value, const std::string& text) {
  try {
    value.set({text});
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

void expect_taken(const Value& value, const std::vector<std::string>& texts) {
  for (const std::string& text : texts) EXPECT_EQ(complaint(value, text), "") << text;
}

void expect_refused(const Value& value, const std::vector<std::string>& texts, const std::string& expected) {
  for (const std::string& text : texts) {
    const auto before = value.get();
    EXPECT_EQ(complaint(value, text), "'" + text + "', expected " + expected) << text;
    EXPECT_EQ(value.get(), before) << text;
  }
}

const std::vector<std::string> kNoNumbers = {"nan", "-nan", "inf",   "-inf", "12abc",
                                             "",    "1,5",  "1e999", "--",   "1 2"};

TEST(Fields, Number) {
  double variable = 1;
  const Value value = number(variable, 0, 180);
  expect_taken(value, {"0", "-0", "180", "1e2", "0.5", "+3", ".5", "5."});
  expect_refused(value, kNoNumbers, "a number from 0 to 180");
  expect_refused(value, {"-1", "-1e-300", "180.0001", "1e300", "+-3"}, "a number from 0 to 180");
}

TEST(Fields, Positive) {
  std::optional<double> variable;
  const Value value = positive(variable, 180);
  EXPECT_FALSE(value.get());
  expect_taken(value, {"180", "1e-300", "0.5"});
  expect_refused(value, kNoNumbers, "a number above 0, at most 180");
  expect_refused(value, {"0", "-0", "-1", "181"}, "a number above 0, at most 180");
}

TEST(Fields, Whole) {
  int variable = 1;
  const Value value = whole(variable, 1, 1000);
  expect_taken(value, {"1", "10", "1000"});
  expect_refused(value, kNoNumbers, "a whole number from 1 to 1000");
  // Octal and hexadecimal notation would pass for other numbers than they look like.
  expect_refused(value, {"0", "1001", "-1", "+1", "1.0", "1e2", "0x10", "010", "99999999999999999999"},
                 "a whole number from 1 to 1000");
  uint64_t seed = 0;
  expect_taken(whole(seed, 0), {"0", "18446744073709551615"});
  expect_refused(whole(seed, 0), {"18446744073709551616", "-1"},
                 "a whole number from 0 to 18446744073709551615");
}

// The text that a value gives sets the same number again, to the last bit.
TEST(Fields, NumbersComeBackAsTheyWere) {
  double variable = 0, other = 0;
  const Value value = number(variable, 0, 1), copy = number(other, 0, 1);
  for (const double v : {0.1, 1.0 / 3, 5e-324, 1 - 1e-16}) {
    variable = v;
    copy.set({*value.get()});
    EXPECT_EQ(other, v);
  }
}

enum class Fruit { kApple, kPear, kPlum };

TEST(Fields, Choices) {
  Fruit fruit = Fruit::kPear;
  const Value one = choice(fruit, {"apple", "pear", "plum"});
  EXPECT_EQ(one.get(), "pear");
  expect_taken(one, {"plum"});
  EXPECT_EQ(fruit, Fruit::kPlum);
  EXPECT_EQ(complaint(one, "nut"), "'nut' is not in {apple,pear,plum}");
  EXPECT_EQ(fruit, Fruit::kPlum);
  std::vector<Fruit> fruits;
  const Value some = choices(fruits, {"apple", "pear", "plum"});
  EXPECT_FALSE(some.get());
  some.set({"plum", "apple"});
  EXPECT_EQ(some.get(), "plum,apple");
  EXPECT_THROW(some.set({"apple", "nut"}), InputError);
  EXPECT_EQ(some.get(), "plum,apple");
}

TEST(Fields, SeveralNumbers) {
  std::vector<int> texel;
  const Value value = whole_numbers(texel, 2, 0, 9);
  value.set({"3", "4"});
  EXPECT_EQ(texel, (std::vector<int>{3, 4}));
  EXPECT_THROW(value.set({"3", "a"}), InputError);
  EXPECT_EQ(texel, (std::vector<int>{3, 4}));
}

}  // namespace
}  // namespace hemibake
