#include "cli/print/progress_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "cli/print/streams.h"

namespace hemibake {
namespace {

std::string with_prefix(double value) {
  if (value >= 1e9) return fmt::format("{:.2f} G", value * 1e-9);
  if (value >= 1e6) return fmt::format("{:.2f} M", value * 1e-6);
  if (value >= 1e3) return fmt::format("{:.2f} k", value * 1e-3);
  return fmt::format("{:.1f} ", value);
}

}  // namespace

void draw_progress_line(const ProgressReport& report) {
  if (report.finished) {
    write_to_standard_error("\r\x1b[K");
    return;
  }
  const double done = static_cast<double>(report.done), total = static_cast<double>(report.total);
  const double rate = done / report.seconds;
  const double fraction = total > 0 ? std::min(1.0, done / total) : 0.0;
  const double left_s = rate > 0 ? std::max(0.0, total - done) / rate : 0.0;
  write_to_standard_error(fmt::format("\r\x1b[K{}: {:3.0f} %  {}{}/s  {:.0f} s left", report.label,
                                      100 * fraction, with_prefix(rate), report.unit, left_s));
}

}  // namespace hemibake
