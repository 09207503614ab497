// Shows a progress line on the terminal, for work that takes longer than a second.
#pragma once

#include <chrono>
#include <cstdint>

namespace maploop::lcm_log {

// It shows nothing if standard error is not a terminal.
class Progress {
 public:
  // `total` is the number of bytes of all work; 0: unknown.
  explicit Progress(std::uint64_t total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // It is cheap enough to be called for each event: it reads the clock once in 256 calls.
  void at(std::uint64_t done) {
    if (terminal_ && (++calls_ & 255U) == 0) show(done);
  }

 private:
  void show(std::uint64_t done);

  using Clock = std::chrono::steady_clock;
  std::uint64_t total_;
  bool terminal_;
  bool shown_ = false;
  std::uint32_t calls_ = 0;
  Clock::time_point next_;
};

}  // namespace maploop::lcm_log
