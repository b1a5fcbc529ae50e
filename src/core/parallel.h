// The one parallel loop. Bodies write only what belongs to their own indices, so that the bytes of every
// result are the same at any thread count.
#pragma once

#include <cstddef>
#include <functional>

namespace hemibake {

// Threads used by parallel_for from now on; 0 means all hardware threads. At least 1.
void set_thread_count(int threads);
int thread_count();

// Calls body(begin, end) for consecutive pieces of [0, count), each `grain` long but the last, in no order.
// Every thread runs with denormals flushed to zero (as Embree wants it). An exception in a body ends the loop
// and is thrown here; an interrupt (core/interrupt.h) throws Interrupted between pieces.
void parallel_for(size_t count, size_t grain, const std::function<void(size_t begin, size_t end)>& body);

// Seconds of CPU time this process has used on all its threads.
double process_cpu_seconds();

// Largest resident set of this process so far, bytes.
size_t peak_memory_bytes();

}  // namespace hemibake
