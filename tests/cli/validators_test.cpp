// Numbers in the notations people type, and notations that are refused.
#include "cli/validators.h"

#include <gtest/gtest.h>

namespace hemibake {
namespace {

std::string complaint(const CLI::Validator& validator, std::string text) { return validator(text); }

void expect_taken(const CLI::Validator& validator, const std::vector<std::string>& texts) {
  for (const std::string& text : texts) EXPECT_EQ(complaint(validator, text), "") << text;
}

void expect_refused(const CLI::Validator& validator, const std::vector<std::string>& texts,
                    const std::string& expected) {
  for (const std::string& text : texts)
    EXPECT_EQ(complaint(validator, text), "'" + text + "', expected " + expected) << text;
}

const std::vector<std::string> kNoNumbers = {"nan", "-nan", "inf",   "-inf", "12abc",
                                             "",    "1,5",  "1e999", "--",   "1 2"};

TEST(Validators, NumberIn) {
  const CLI::Validator validator = number_in(0, 180);
  expect_taken(validator, {"0", "-0", "180", "1e2", "0.5", "+3", ".5", "5."});
  expect_refused(validator, kNoNumbers, "a number from 0 to 180");
  expect_refused(validator, {"-1", "-1e-300", "180.0001", "1e300"}, "a number from 0 to 180");
}

TEST(Validators, PositiveTo) {
  const CLI::Validator validator = positive_to(180);
  expect_taken(validator, {"180", "1e-300", "0.5"});
  expect_refused(validator, kNoNumbers, "a number above 0, at most 180");
  expect_refused(validator, {"0", "-0", "-1", "181"}, "a number above 0, at most 180");
}

TEST(Validators, WholeNumberIn) {
  const CLI::Validator validator = whole_number_in(1, 1000);
  expect_taken(validator, {"1", "10", "1000"});
  expect_refused(validator, kNoNumbers, "a whole number from 1 to 1000");
  // Octal and hexadecimal notation would be read as other numbers than they look like.
  expect_refused(validator, {"0", "1001", "-1", "+1", "1.0", "1e2", "0x10", "010", "99999999999999999999"},
                 "a whole number from 1 to 1000");
  expect_taken(whole_number_in(0, UINT64_MAX), {"0", "18446744073709551615"});
  expect_refused(whole_number_in(0, UINT64_MAX), {"18446744073709551616", "-1"},
                 "a whole number from 0 to 18446744073709551615");
}

}  // namespace
}  // namespace hemibake
