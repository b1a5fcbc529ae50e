#include "core/parallel.h"

#include <pmmintrin.h>
#include <sys/resource.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <ctime>
#include <memory>

#include "core/interrupt.h"

namespace hemibake {
namespace {

std::unique_ptr<tbb::global_control> thread_limit;

}  // namespace

void set_thread_count(int threads) {
  const int wanted = threads > 0 ? threads : tbb::info::default_concurrency();
  thread_limit.reset();
  thread_limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                       static_cast<size_t>(std::max(1, wanted)));
}

int thread_count() {
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

void parallel_for(size_t count, size_t grain, const std::function<void(size_t, size_t)>& body) {
  if (count == 0) return;
  const size_t step = std::max<size_t>(1, grain);
  const size_t pieces = (count + step - 1) / step;
  tbb::parallel_for(
      size_t{0}, pieces,
      [&](size_t piece) {
        throw_if_interrupted();
        const unsigned saved = _mm_getcsr();
        _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
        _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
        struct Restore {
          unsigned csr;
          ~Restore() { _mm_setcsr(csr); }
        } restore{saved};
        const size_t begin = piece * step;
        body(begin, std::min(count, begin + step));
      },
      tbb::simple_partitioner{});
  throw_if_interrupted();
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
