#include "tests/examples/wheel_log.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace maploop::example {

WheelLog::WheelLog(const std::filesystem::path& file, Duration delay, double sigma)
    : name_(file.string()), rows_(file), delay_(delay), sigma_(sigma) {
  if (!rows_) {
    throw std::runtime_error("cannot read the wheels' log '" + name_ + "': there is no such file");
  }
}

bool WheelLog::next(WheelSpeed& sample) {
  for (std::string row; std::getline(rows_, row);) {
    ++line_;
    std::istringstream in(row);
    double seconds = 0.0, speed = 0.0;
    char comma = 0;
    if (!(in >> seconds >> comma >> speed) || comma != ',' || !std::isfinite(speed) ||
        !(seconds > 0.0 && seconds < 4e9)) {
      report_.refuse({name_, line_, "'" + row + "' is no row of 'seconds,m/s'"});
      continue;
    }
    const Time delivered = from_nanoseconds(0) + from_seconds(seconds);
    if (delivered <= last_) {
      report_.refuse({name_, line_, "it is not later than the row before"});
      continue;
    }
    last_ = delivered;
    sample.stamp = delivered - delay_;
    sample.available = delivered;
    sample.sequence = line_ - 1;  // the recording's own number, so that a row left out is a gap
    sample.speed = speed;
    sample.sigma = sigma_;
    ++report_.delivered;
    return true;
  }
  return false;
}

}  // namespace maploop::example
