// The three ways a command ends early.
#pragma once

#include <stdexcept>
#include <string>

namespace hemibake {

// Input or usage that cannot be used: exit 2. The message names the file, the value and what was expected:
// "FILE: what was wrong, what was expected".
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A check or a fit that failed on usable input: exit 1.
class CheckError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The caller cancelled the work: exit 130.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled") {}
};

// A bug: throws std::logic_error naming `what` and both values.
[[noreturn]] void fail_expectation(const std::string& what, double actual, double expected);

template <class A, class B>
void expect_equal(const A& actual, const B& expected, const std::string& what) {
  if (!(actual == expected))
    fail_expectation(what, static_cast<double>(actual), static_cast<double>(expected));
}

}  // namespace hemibake
