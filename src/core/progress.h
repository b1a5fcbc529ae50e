// A step of long work that reports how far it is to the context in force.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>

#include "core/context.h"

namespace hemibake {

class Progress {
 public:
  // label: what is being done ("tracing"). total: how much there is of it, in `unit` ("receiver"); may be
  // exceeded.
  Progress(std::string label, uint64_t total, std::string unit);
  // Reports the step as finished, where it was reported at all.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // Adds `amount` to what is done. Any thread.
  void advance(uint64_t amount);

 private:
  void report(bool finished);

  const Context& context_;
  ProgressReport state_;
  std::atomic<uint64_t> done_{0};
  std::atomic<int64_t> next_report_ms_;
  std::chrono::steady_clock::time_point start_;
  std::mutex reporting_;
  bool reported_ = false;
};

}  // namespace hemibake
