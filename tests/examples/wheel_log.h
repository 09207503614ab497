// This example of a sensor driver reads wheel speeds from a text file with one row "seconds,m/s"
// for each sample.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "msgs/wheel_speed.h"
#include "sensors/source.h"

namespace maploop::example {

// Seconds are UTC. Throws std::runtime_error if the file cannot be read; a row that is not a
// sample, or not later than the one before, is left out and reported.
class WheelLog final : public sensors::Source<WheelSpeed> {
 public:
  // The sensor delivers a speed `delay` after it was measured, with white noise of `sigma` (m/s).
  WheelLog(const std::filesystem::path& file, Duration delay, double sigma);

  bool next(WheelSpeed& sample) override;
  const sensors::SourceReport& report() const override { return report_; }

 private:
  std::string name_;
  std::ifstream rows_;
  Duration delay_;
  double sigma_;
  std::size_t line_ = 0;
  Time last_ = Time::min();
  sensors::SourceReport report_;
};

}  // namespace maploop::example
