// Work in a process of its own: its memory is its own, its threads are new, and what it leaks or crashes on
// stays there.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace hemibake {

// work() in a forked copy of this process; what it returned. InputError, CheckError and Cancelled thrown
// there are thrown here again, anything else as std::runtime_error naming `what`. An interrupt here ends the
// child. This process must not have called parallel_for: a fork has none of its threads. (Threads that
// libraries start when they are loaded, such as OpenImageIO's logger, sleep and are not missed.)
std::string run_in_child(const std::string& what, const std::function<std::string()>& work);

// How much memory this process takes for something: construct, work, ask.
class MemoryProbe {
 public:
  MemoryProbe();
  // Largest resident set since then, less the one at the start, bytes. Pages already freed by earlier work
  // are used again without counting: in a new process there are few.
  size_t peak_growth_bytes() const;

 private:
  size_t at_start_bytes_;
};

}  // namespace hemibake
