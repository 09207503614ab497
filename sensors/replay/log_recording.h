// This file replays one of our own recordings (LCM log or MCAP): its channels contain what the
// sensors delivered.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "msgs/calibration.h"
#include "msgs/gnss.h"
#include "msgs/image.h"
#include "msgs/imu.h"
#include "msgs/lidar_scan.h"
#include "msgs/odometry.h"
#include "msgs/reference.h"
#include "msgs/wheel_speed.h"
#include "sensors/source.h"

namespace maploop::sensors {

// Reads a log that `maploop replay --record` wrote, also compressed: IMU, GNSS_FIX, WHEEL_SPEED,
// TRUTH, ODOMETRY, VO, LIDAR_ODOMETRY, and CAMERA and VELODYNE if raw sensors were recorded. Each
// sample has the stamps and the bits it had. Sources may outlive the recording, and each may run on
// its own thread.
class LogRecording {
 public:
  // Reads through the whole log once. Throws std::runtime_error that names the log and states what
  // to do: not readable, damaged, without a calibration, without any sensor.
  explicit LogRecording(const std::filesystem::path& log);

  // Returns what the first calibration of a log says; nothing if it has none, or is no log.
  static std::optional<FusedSensors> fused_sensors_of(const std::filesystem::path& log);

  const VehicleCalibration& calibration() const { return calibration_; }

  // These describe the first channel that the log has of the images and the odometry made from
  // them; without these, the sensor that begins first.
  std::size_t frame_count() const { return frame_count_; }
  Time first_stamp() const { return first_stamp_; }
  Time last_stamp() const { return last_stamp_; }

  // Each call returns a new source of a channel (msgs/lcm/channel_names.h), whose messages contain
  // samples of type T, from the start of the log; or nullptr if the log has no such channel. A
  // message that cannot be read, or is not later than the previous one, is left out and reported.
  template <class T>
  std::unique_ptr<Source<T>> source(std::string_view channel) const;

 private:
  std::filesystem::path log_;
  VehicleCalibration calibration_;
  std::set<std::string, std::less<>> channels_;
  std::size_t frame_count_ = 0;
  Time first_stamp_{};
  Time last_stamp_{};
};

}  // namespace maploop::sensors
