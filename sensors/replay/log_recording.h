// One of our own LCM logs as a recording: what its channels say is what the sensors said.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
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

// Reads what `maploop replay --record` wrote, plain or .gz: IMU, GNSS_FIX, WHEEL_SPEED, TRUTH,
// ODOMETRY, VO, LIDAR_ODOMETRY, and CAMERA and VELODYNE where raw sensors were recorded, each
// sample with the stamps and the bits it had. Sources may outlive the recording, and may each run
// on a thread of its own.
class LogRecording {
 public:
  // Reads through the whole log once. Throws std::runtime_error naming the log and what to do: not
  // readable, damaged, without a calibration, without any sensor.
  explicit LogRecording(const std::filesystem::path& log);

  const VehicleCalibration& calibration() const { return calibration_; }

  // Of the images, or of the odometry that was made from them, or of the inertial samples: the
  // first of these that the log has.
  std::size_t frame_count() const { return frame_count_; }
  Time first_stamp() const { return first_stamp_; }
  Time last_stamp() const { return last_stamp_; }

  // New sources, each from the start of the log; nullptr where the log has no such channel. A
  // message that cannot be read, or is not later than the one before, is left out and reported.
  std::unique_ptr<Source<StereoPair>> camera() const;
  std::unique_ptr<Source<LidarScan>> velodyne() const;
  std::unique_ptr<Source<ImuSample>> imu() const;
  std::unique_ptr<Source<GnssFix>> gnss() const;
  std::unique_ptr<Source<WheelSpeed>> wheel() const;
  std::unique_ptr<Source<ReferencePose>> reference() const;
  std::unique_ptr<Source<RelativeMotion>> odometry() const;  // what fusion got
  std::unique_ptr<Source<RelativeMotion>> visual_odometry() const;
  std::unique_ptr<Source<LidarMotion>> lidar_odometry() const;

 private:
  template <class T, class Lcm>
  std::unique_ptr<Source<T>> source(std::string_view channel) const;

  std::filesystem::path log_;
  VehicleCalibration calibration_;
  std::set<std::string, std::less<>> channels_;
  std::size_t frame_count_ = 0;
  Time first_stamp_{};
  Time last_stamp_{};
};

}  // namespace maploop::sensors
