// How a command ends that did not come to its own end.
#pragma once

#include <exception>
#include <string>

namespace hemibake {

// Exit codes besides 0.
constexpr int kExitFailedCheck = 1;
constexpr int kExitBadInput = 2;
constexpr int kExitInternalError = 70;  // EX_SOFTWARE of sysexits.h
constexpr int kExitInterrupted = 130;

struct Ending {
  int exit_code = 0;
  std::string message;  // one line
};

// Returns the exit code and the line of an exception: bad input, a failed check, an interrupt, memory or
// threads that the system has not. Anything else is an error of this program.
Ending ending_of(const std::exception_ptr& exception);

// Makes exceptions that nothing can catch, as of a thread or in a destructor, end the process as ending_of
// says.
void end_on_uncaught_exceptions();

}  // namespace hemibake
