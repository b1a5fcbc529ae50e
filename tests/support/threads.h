// The number of threads of the calls that follow, for tests of the same bytes at any.
#pragma once

#include <optional>

#include "core/context.h"

namespace hemibake {

// Puts a context of so many threads in force on this thread; 0: none, all hardware threads.
inline void set_thread_count(int threads) {
  static Context context;
  static std::optional<ContextScope> scope;
  scope.reset();
  context.threads = threads;
  if (threads > 0) scope.emplace(context);
}

}  // namespace hemibake
