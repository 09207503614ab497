#include "tools/log/progress.h"

#include <unistd.h>

#include <cstdio>

namespace maploop::lcm_log {

Progress::Progress(std::uint64_t total)
    : total_(total),
      terminal_(isatty(STDERR_FILENO) != 0),
      next_(Clock::now() + std::chrono::seconds(1)) {}

Progress::~Progress() {
  if (shown_) std::fprintf(stderr, "\r%40s\r", "");
}

void Progress::show(std::uint64_t done) {
  const auto now = Clock::now();
  if (now < next_) return;
  next_ = now + std::chrono::milliseconds(200);
  shown_ = true;
  const double megabytes = static_cast<double>(done) * 1e-6;
  if (total_ == 0) {
    std::fprintf(stderr, "\r%10.0f MB", megabytes);
  } else {
    const double all = static_cast<double>(total_) * 1e-6;
    std::fprintf(stderr, "\r%10.0f MB of %.0f MB  %3.0f %%", megabytes, all,
                 100.0 * megabytes / all);
  }
}

}  // namespace maploop::lcm_log
