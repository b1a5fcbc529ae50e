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

// An input error that names settings, each in braces in the message: "{rays}: is chosen by {target-error}".
// what() has them as plain words; whoever has other words for them, as a command line has, asks for these.
class SettingError : public InputError {
 public:
  // file: put before the message, "FILE: …", where it is about one.
  explicit SettingError(const std::string& message, const std::string& file = "")
      : InputError(text(message, file, "")), message_(message), file_(file) {}
  // Returns the error with the file it is about.
  SettingError in_file(const std::string& file) const { return SettingError(message_, file); }
  // Returns the message with `prefix` before every setting's name.
  std::string with_prefix(const std::string& prefix) const { return text(message_, file_, prefix); }

 private:
  static std::string text(const std::string& message, const std::string& file, const std::string& prefix);
  std::string message_, file_;
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
