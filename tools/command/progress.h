// Shows how far work is that takes a while.
#pragma once

#include <chrono>
#include <mutex>
#include <string>

namespace maploop::tools {

// Returns such as "120 of 400 frames, 30 %, 12 s left"; `all` is 0 where it is not known.
std::string progress_text(const std::string& unit, double done, double all, double seconds);

// Writes to standard error, once the work has taken two seconds: over one line of a terminal, else
// a line every ten seconds. at() may be called from any thread.
class Progress {
 public:
  explicit Progress(std::string unit) : unit_(std::move(unit)) {}
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void at(double done, double all = 0.0);

 private:
  using Clock = std::chrono::steady_clock;

  std::string unit_;
  std::mutex mutex_;
  Clock::time_point begin_ = Clock::now(), next_{};
  bool shown_ = false;
};

}  // namespace maploop::tools
