#include "core/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace hemibake {
namespace {

using std::chrono::steady_clock;
constexpr int64_t kFirstDrawMs = 1000;
constexpr int64_t kRedrawMs = 200;

std::string scaled(double value) {
  if (value >= 1e9) return fmt::format("{:.2f} G", value * 1e-9);
  if (value >= 1e6) return fmt::format("{:.2f} M", value * 1e-6);
  if (value >= 1e3) return fmt::format("{:.2f} k", value * 1e-3);
  return fmt::format("{:.1f} ", value);
}

}  // namespace

Progress::Progress(std::string label, uint64_t total, std::string unit)
    : label_(std::move(label)),
      unit_(std::move(unit)),
      total_(total),
      next_draw_ms_(kFirstDrawMs),
      start_(steady_clock::now()),
      terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (drawn_) fmt::print(stderr, "\r\x1b[K");
}

void Progress::advance(uint64_t amount) {
  done_.fetch_add(amount, std::memory_order_relaxed);
  if (!terminal_) return;
  const auto now = steady_clock::now();
  const int64_t elapsed_ms = std::chrono::duration_cast<std::chrono::milliseconds>(now - start_).count();
  int64_t due = next_draw_ms_.load(std::memory_order_relaxed);
  if (elapsed_ms >= due && next_draw_ms_.compare_exchange_strong(due, elapsed_ms + kRedrawMs)) draw(now);
}

void Progress::draw(steady_clock::time_point now) {
  const std::lock_guard lock(drawing_);
  const double seconds = std::chrono::duration<double>(now - start_).count();
  const double done = static_cast<double>(done_.load());
  const double rate = done / seconds;
  const double fraction = total_ > 0 ? std::min(1.0, done / static_cast<double>(total_)) : 0.0;
  const double left_s = rate > 0 ? std::max(0.0, static_cast<double>(total_) - done) / rate : 0.0;
  fmt::print(stderr, "\r\x1b[K{}: {:3.0f} %  {}{}/s  {:.0f} s left", label_, 100 * fraction, scaled(rate),
             unit_, left_s);
  std::fflush(stderr);
  drawn_ = true;
}

}  // namespace hemibake
