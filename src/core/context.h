// A caller's side of long work: threads, progress, a way to stop it, and what to record of the call.
//
// An entry point of the library takes a Context and puts it in force for its thread with a ContextScope. The
// loops below (core/parallel.h) hand it to their workers, so that nothing in between has to pass it on, and
// two calls on two threads do not see each other's.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace hemibake {

// One step of long work, as it stands. `done` may exceed `total`.
struct ProgressReport {
  std::string label, unit;  // "tracing", "receiver"
  uint64_t done = 0, total = 0;
  double seconds = 0;     // since the step began
  bool finished = false;  // the last report of the step
};

struct Context {
  int threads = 0;  // 0: all hardware threads
  // Is called from any thread, one call at a time, at most five times a second.
  std::function<void(const ProgressReport&)> progress;
  const std::atomic<bool>* cancel = nullptr;  // work ends with Cancelled soon after this becomes true
  std::string command;                        // recorded as what made a file; empty: none
};

// Puts a context in force for the calling thread until the scope ends. `context` must outlive it.
class ContextScope {
 public:
  explicit ContextScope(const Context& context);
  ~ContextScope();
  ContextScope(const ContextScope&) = delete;
  ContextScope& operator=(const ContextScope&) = delete;

 private:
  struct Threads;
  std::unique_ptr<Threads> threads_;
  const Context* outer_context_;
  Threads* outer_threads_;
  static thread_local Threads* in_force_;
  friend void parallel_for(size_t, size_t, const std::function<void(size_t, size_t)>&);
};

// Returns the context in force; without one: all hardware threads, no progress, no way to stop.
const Context& current_context();

// Returns whether the caller wants the work to stop.
bool cancel_requested();

// Throws Cancelled where the caller wants the work to stop.
void throw_if_cancelled();

}  // namespace hemibake
