// The one parallel loop. Bodies write only what belongs to their own indices, so that the bytes of every
// result are the same at any thread count.
#pragma once

#include <cstddef>
#include <functional>

namespace hemibake {

// Returns the threads of the context in force (core/context.h), at least 1.
int thread_count();

// Calls body(begin, end) for consecutive pieces of [0, count), each `grain` long but the last, in no order,
// on the threads of the context in force. Every thread runs with denormals flushed to zero. An exception in a
// body ends the loop and is thrown here; a cancelled context throws Cancelled between pieces.
void parallel_for(size_t count, size_t grain, const std::function<void(size_t begin, size_t end)>& body);

// Returns the CPU seconds this process has used on all its threads.
double process_cpu_seconds();

// Returns the largest resident set of this process so far, bytes.
size_t peak_memory_bytes();

}  // namespace hemibake
