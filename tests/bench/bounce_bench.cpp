// Bounces against the machine's memory: bytes of links read per second in 20 bounces over the bandwidth of a
// copy measured in the same run, per CPU second and per second of the clock. A copy of n bytes counts twice,
// read and written, as STREAM does (McCalpin 1995).
//
//   hemibake_bench_bounce [SIDE] [AZIMUTHS]     texels along a side (512), azimuths per receiver (32)
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "bench/bench_maps.h"
#include "core/parallel.h"
#include "tracers/slice/slice.h"
#include "transport/trace_surface.h"

namespace hemibake {
namespace {

constexpr int kBounces = 20;
constexpr int kRepeats = 5;

struct Rate {
  double per_cpu_second = 0, per_second = 0;
};

// The best of several runs of work that moves `bytes`.
template <class Work>
Rate best_rate(double bytes, const Work& work) {
  Rate best;
  for (int i = 0; i < kRepeats; ++i) {
    const auto start = std::chrono::steady_clock::now();
    const double cpu_start = process_cpu_seconds();
    work();
    const double cpu = process_cpu_seconds() - cpu_start;
    const double clock = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    best.per_cpu_second = std::max(best.per_cpu_second, 1e-9 * bytes / cpu);
    best.per_second = std::max(best.per_second, 1e-9 * bytes / clock);
  }
  return best;
}

Rate copy_rate() {
  constexpr size_t kBytes = size_t{256} << 20, kPiece = size_t{1} << 20;  // far beyond any cache
  const std::vector<char> from(kBytes, 1);
  std::vector<char> to(kBytes, 2);
  return best_rate(2.0 * kBytes, [&] {
    parallel_for(kBytes, kPiece, [&](size_t begin, size_t end) {
      std::memcpy(to.data() + begin, from.data() + begin, end - begin);
    });
  });
}

void run(const BenchMap& map, int azimuths, const Rate& copy) {
  SliceOptions options;
  options.azimuths = azimuths;
  const LightTransport seen = trace_surface(*make_slice_tracer(map.surface, options), KeptLinks::kAll);
  const FormFactorMatrix& links = seen.patch_form_factors;
  std::vector<double> light(seen.patch_direct().begin(), seen.patch_direct().end()), next(light.size());
  const Rate rate = best_rate(static_cast<double>(kBounces * links.stored_bytes()), [&] {
    for (int b = 0; b < kBounces; ++b) {
      multiply(links, light, next);
      light.swap(next);
    }
  });
  fmt::print("{:16} {:8.1f} {:8.1f} {:7.3f} {:9.2f} {:7.1f} % {:9.2f} {:7.1f} %\n", map.name,
             static_cast<double>(links.count()) / links.rows, 1e-6 * static_cast<double>(links.count()),
             static_cast<double>(links.stored_bytes()) / static_cast<double>(links.count()),
             rate.per_cpu_second, 100 * rate.per_cpu_second / copy.per_cpu_second, rate.per_second,
             100 * rate.per_second / copy.per_second);
}

}  // namespace
}  // namespace hemibake

int main(int argc, char** argv) {
  const int side = argc > 1 ? std::atoi(argv[1]) : 512;
  const int azimuths = argc > 2 ? std::atoi(argv[2]) : 32;
  const hemibake::Rate copy = hemibake::copy_rate();
  fmt::print("copy: {:.2f} GB per cpu-s, {:.2f} GB/s on {} threads\n", copy.per_cpu_second, copy.per_second,
             hemibake::thread_count());
  fmt::print("{:16} {:>8} {:>8} {:>7} {:>9} {:>9} {:>9} {:>9}\n", "map", "links/row", "M links", "B/link",
             "GB/cpu-s", "of copy", "GB/s", "of copy");
  for (const hemibake::BenchMap& map : hemibake::bench_maps(side)) hemibake::run(map, azimuths, copy);
}
