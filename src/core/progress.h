// A progress line on standard error with rate and time left: only on a terminal, only for work over a second.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

namespace hemibake {

class Progress {
 public:
  // label: what is being done ("tracing"). total: how much there is of it, in `unit` ("ray"); may be
  // exceeded.
  Progress(std::string label, uint64_t total, std::string unit);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // Says that `amount` more is done. Any thread.
  void advance(uint64_t amount);

 private:
  void draw(std::chrono::steady_clock::time_point now);

  std::string label_;
  std::string unit_;
  uint64_t total_;
  std::atomic<uint64_t> done_{0};
  std::atomic<int64_t> next_draw_ms_;
  std::chrono::steady_clock::time_point start_;
  std::mutex drawing_;
  bool terminal_;
  bool drawn_ = false;
};

}  // namespace hemibake
