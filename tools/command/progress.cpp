#include "tools/command/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "tools/command/terminal.h"

namespace maploop::tools {

using std::chrono::duration;
using std::chrono::milliseconds;
using std::chrono::seconds;

std::string progress_text(const std::string& unit, double done, double all, double took) {
  if (all <= 0.0) return fmt::format("{:.0f} {}, {:.0f} s", done, unit, took);
  const double share = std::clamp(done / all, 1e-6, 1.0);
  return fmt::format("{:.0f} of {:.0f} {}, {:.0f} %, {:.0f} s left", done, all, unit, 100.0 * share,
                     took * (1.0 - share) / share);
}

void Progress::at(double done, double all) {
  const std::lock_guard lock(mutex_);
  const auto now = Clock::now();
  const bool screen = is_screen(STDERR_FILENO);
  if (next_ == Clock::time_point{}) next_ = begin_ + (screen ? seconds(2) : seconds(10));
  if (now < next_) return;
  next_ = now + (screen ? milliseconds(200) : milliseconds(10'000));
  const std::string text = progress_text(unit_, done, all, duration<double>(now - begin_).count());
  if (screen) {
    show_status(STDERR_FILENO, text);
    shown_ = true;
  } else {
    fmt::print(stderr, "{}\n", text);
  }
}

Progress::~Progress() {
  if (shown_) show_status(STDERR_FILENO, "");
}

}  // namespace maploop::tools
