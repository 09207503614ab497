// This file says what a recording contains, sensor by sensor, and how sound it is.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "runtime/vehicle/drivers/recording.h"
#include "tools/web/table.h"

namespace maploop::tools {

// Counts a sensor's samples in parts of equal length from the recording's first stamp to its last.
struct SampleTimes {
  static constexpr std::size_t parts = 300;
  std::vector<std::uint32_t> samples = std::vector<std::uint32_t>(parts);
  std::vector<double> delay = std::vector<double>(parts);  // ms, the longest; 0 without a sample
};

// Describes one sensor's samples from first to last.
struct SensorHealth {
  std::string name;
  std::uint64_t samples = 0, left_out = 0;
  double rate = 0.0;           // Hz, of the median period
  double jitter = 0.0;         // ms, 90 % of the periods are within it of the median
  double longest_gap = 0.0;    // s
  double gap_at = 0.0;         // s into the recording
  double delay = 0.0;          // ms, median time from the stamp to the delivery
  std::uint64_t repeated = 0;  // inertial samples whose values are those of the one before
  std::string finding;         // the first reason for leaving out a sample
  SampleTimes times;
};

extern const web::Columns<SensorHealth> sensor_health_columns;

// How far a sensor is read, by the stamp of its last sample.
using ExamineProgress = std::function<void(const char* sensor, Time at)>;

// Reads every sensor to its end, without pixels and points.
std::vector<SensorHealth> examine(
    const vehicle::Recording& recording,
    const ExamineProgress& progress = [](const char*, Time) {});

// Returns sentences: what is wrong with the sensors, what can be computed from them, and which
// command does it. `path` is how the user names the recording.
std::vector<std::string> advice(const std::vector<SensorHealth>& sensors, const std::string& path);

}  // namespace maploop::tools
