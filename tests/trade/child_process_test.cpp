#include "trade/child_process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <vector>

#include "core/error.h"

namespace hemibake {
namespace {

TEST(ChildProcess, SendsBackWhatTheWorkReturned) {
  int touched = 0;
  const std::string long_text(1 << 20, 'x');  // more than a pipe holds
  const std::string answer = run_in_child("work", [&] {
    ++touched;
    return std::to_string(getpid()) + long_text;
  });
  EXPECT_EQ(touched, 0);  // in the child, not here
  EXPECT_NE(answer, std::to_string(getpid()) + long_text);
  EXPECT_TRUE(answer.ends_with(long_text));
}

TEST(ChildProcess, ThrowsWhatTheWorkThrew) {
  EXPECT_THROW(run_in_child("work", []() -> std::string { throw InputError("a.png: bad, expected good"); }),
               InputError);
  EXPECT_THROW(run_in_child("work", []() -> std::string { throw CheckError("no"); }), CheckError);
  EXPECT_THROW(run_in_child("work", []() -> std::string { throw Cancelled(); }), Cancelled);
  try {
    run_in_child("the work", []() -> std::string { throw std::logic_error("a bug"); });
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "the work: a bug");
  }
}

TEST(ChildProcess, SaysWhatEndedIt) {
  try {
    run_in_child("work", []() -> std::string {
      raise(SIGKILL);
      return "";
    });
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("work: its process was killed, most likely out of memory"));
  }
}

TEST(ChildProcess, MemoryIsThatOfTheWork) {
#ifdef HEMIBAKE_SANITIZED
  GTEST_SKIP() << "sanitizers keep memory of their own beside it";
#endif
  constexpr size_t kBytes = size_t{64} << 20;
  const std::string answer = run_in_child("work", [] {
    const MemoryProbe probe;
    {
      std::vector<char> large(kBytes, 1);
      if (large[kBytes / 2] != 1) return std::string("?");
    }
    return std::to_string(probe.peak_growth_bytes());
  });
  // Freed at the end, and still the peak. Pages are counted per thread in batches: a megabyte either way.
  EXPECT_NEAR(std::stod(answer), kBytes, 1 << 20);
}

}  // namespace
}  // namespace hemibake
