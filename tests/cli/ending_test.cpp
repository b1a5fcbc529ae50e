#include "cli/ending.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <new>
#include <system_error>
#include <thread>

#include "core/error.h"
#include "core/parallel.h"

namespace hemibake {
namespace {

using testing::HasSubstr;

template <class Exception>
Ending ending_with(const Exception& exception) {
  return ending_of(std::make_exception_ptr(exception));
}

TEST(Ending, OfWhatIsExpected) {
  EXPECT_EQ(ending_with(InputError("a")).exit_code, 2);
  EXPECT_EQ(ending_with(SettingError("{rays}: none", "map")).message, "map: --rays: none");
  EXPECT_EQ(ending_with(CheckError("a")).exit_code, 1);
  EXPECT_EQ(ending_with(Cancelled()).exit_code, 130);
  EXPECT_EQ(ending_with(std::bad_alloc()).exit_code, 2);
  EXPECT_EQ(ending_with(std::bad_array_new_length()).exit_code, 2);
  EXPECT_EQ(ending_with(std::system_error(EAGAIN, std::generic_category())).exit_code, 2);
  EXPECT_EQ(ending_with(std::runtime_error("pthread_create has failed: Resource temporarily unavailable"))
                .exit_code,
            2);
}

TEST(Ending, OfWhatEscaped) {
  const auto expect_internal = [](const Ending& ending, const std::string& what) {
    EXPECT_EQ(ending.exit_code, 70);
    EXPECT_EQ(ending.message,
              "internal error: " + what + "; please report it with the command and its input");
  };
  expect_internal(ending_with(std::logic_error("rows differ")), "rows differ");
  expect_internal(ending_with(std::runtime_error("r")), "r");
  expect_internal(ending_with(3), "an exception of an unknown type");
  EXPECT_EQ(ending_with(std::filesystem::filesystem_error("f", std::error_code())).exit_code, 70);
}

TEST(Ending, OfALoopOverThreads) {
  std::exception_ptr escaped;
  try {
    parallel_for(100, 1, [](size_t begin, size_t) {
      if (begin == 50) throw 3;
    });
  } catch (...) {
    escaped = std::current_exception();
  }
  EXPECT_EQ(ending_of(escaped).exit_code, 70);
}

TEST(EndingDeathTest, OfAThread) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  const auto throw_in_thread = [](auto exception) {
    end_on_uncaught_exceptions();
    std::thread([&] { throw exception; }).join();
  };
  EXPECT_EXIT(throw_in_thread(std::logic_error("rows differ")), testing::ExitedWithCode(70),
              "hemibake: internal error: rows differ; please report");
  EXPECT_EXIT(throw_in_thread(InputError("map.png: is bad")), testing::ExitedWithCode(2),
              "hemibake: map.png: is bad");
}

}  // namespace
}  // namespace hemibake
