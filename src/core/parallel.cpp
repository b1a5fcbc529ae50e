#include "core/parallel.h"

#include <pmmintrin.h>
#include <sys/resource.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <ctime>
#include <optional>

#if defined(__SANITIZE_THREAD__)
#define HEMIBAKE_TSAN
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define HEMIBAKE_TSAN
#endif
#endif
#ifdef HEMIBAKE_TSAN
#include <sanitizer/tsan_interface.h>
#endif

#include "core/context.h"
#include "core/error.h"

namespace hemibake {

// The threads of a context. More than the hardware has are made only where oneTBB is told that there may be.
struct ContextScope::Threads {
  explicit Threads(int count) : arena(count) {
    if (count > tbb::info::default_concurrency())
      more_threads.emplace(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(count));
  }
  std::optional<tbb::global_control> more_threads;
  tbb::task_arena arena;
};

namespace {

thread_local const Context* context_in_force = nullptr;

// Makes `context` the one in force on a worker while it runs a piece.
struct WorkerContext {
  explicit WorkerContext(const Context* context) : outer(context_in_force) { context_in_force = context; }
  ~WorkerContext() { context_in_force = outer; }
  const Context* outer;
};

// Flushes denormals to zero, as Embree wants it, and restores the thread's own mode.
struct FlushedDenormals {
  FlushedDenormals() {
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
  }
  ~FlushedDenormals() { _mm_setcsr(saved); }
  unsigned saved = _mm_getcsr();
};

// Tells ThreadSanitizer what oneTBB orders, which it cannot see in a library that is not built with it:
// pieces begin after what came before the loop, and what comes after the loop begins after all pieces.
struct LoopOrder {
#ifdef HEMIBAKE_TSAN
  LoopOrder() { __tsan_release(&begun); }
  ~LoopOrder() { __tsan_acquire(&ended); }
  void begin_piece() { __tsan_acquire(&begun); }
  void end_piece() { __tsan_release(&ended); }
  char begun, ended;
#else
  void begin_piece() {}
  void end_piece() {}
#endif
};

}  // namespace

thread_local ContextScope::Threads* ContextScope::in_force_ = nullptr;

ContextScope::ContextScope(const Context& context)
    : threads_(std::make_unique<Threads>(context.threads > 0 ? context.threads
                                                             : tbb::info::default_concurrency())),
      outer_context_(context_in_force),
      outer_threads_(in_force_) {
  context_in_force = &context;
  in_force_ = threads_.get();
}

ContextScope::~ContextScope() {
  context_in_force = outer_context_;
  in_force_ = outer_threads_;
}

const Context& current_context() {
  static const Context kNone;
  return context_in_force ? *context_in_force : kNone;
}

bool cancel_requested() {
  const std::atomic<bool>* cancel = current_context().cancel;
  return cancel && cancel->load(std::memory_order_relaxed);
}

void throw_if_cancelled() {
  if (cancel_requested()) throw Cancelled();
}

int thread_count() {
  const int wanted = current_context().threads;
  return wanted > 0 ? wanted : tbb::info::default_concurrency();
}

void parallel_for(size_t count, size_t grain, const std::function<void(size_t, size_t)>& body) {
  if (count == 0) return;
  const size_t step = std::max<size_t>(1, grain);
  const size_t pieces = (count + step - 1) / step;
  const Context* context = context_in_force;
  LoopOrder order;
  const auto run_piece = [&](size_t piece) {
    order.begin_piece();
    const WorkerContext in_force(context);
    throw_if_cancelled();
    const FlushedDenormals flushed;
    const size_t begin = piece * step;
    body(begin, std::min(count, begin + step));
    order.end_piece();
  };
  const auto run_all = [&] { tbb::parallel_for(size_t{0}, pieces, run_piece, tbb::simple_partitioner{}); };
  if (ContextScope::in_force_) {
    ContextScope::in_force_->arena.execute(run_all);
  } else {
    run_all();
  }
  throw_if_cancelled();
}

double process_cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

size_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<size_t>(usage.ru_maxrss) * 1024;
}

}  // namespace hemibake
