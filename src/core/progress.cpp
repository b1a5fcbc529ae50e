#include "core/progress.h"

namespace hemibake {
namespace {

using std::chrono::steady_clock;
constexpr int64_t kFirstReportMs = 1000;
constexpr int64_t kReportEveryMs = 200;

}  // namespace

Progress::Progress(std::string label, uint64_t total, std::string unit)
    : context_(current_context()), next_report_ms_(kFirstReportMs), start_(steady_clock::now()) {
  state_.label = std::move(label);
  state_.unit = std::move(unit);
  state_.total = total;
}

Progress::~Progress() {
  if (reported_) report(true);
}

void Progress::advance(uint64_t amount) {
  done_.fetch_add(amount, std::memory_order_relaxed);
  if (!context_.progress) return;
  const auto elapsed = steady_clock::now() - start_;
  const int64_t elapsed_ms = std::chrono::duration_cast<std::chrono::milliseconds>(elapsed).count();
  int64_t due = next_report_ms_.load(std::memory_order_relaxed);
  if (elapsed_ms >= due && next_report_ms_.compare_exchange_strong(due, elapsed_ms + kReportEveryMs))
    report(false);
}

void Progress::report(bool finished) {
  const std::lock_guard lock(reporting_);
  state_.done = done_.load();
  state_.seconds = std::chrono::duration<double>(steady_clock::now() - start_).count();
  state_.finished = finished;
  context_.progress(state_);
  reported_ = true;
}

}  // namespace hemibake
