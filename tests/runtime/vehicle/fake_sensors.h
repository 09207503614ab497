// Defines small synthetic sensors. The graph does not need realistic images, so these are plain
// noise, which costs little and which the odometry refuses by name.
#pragma once

#include <cstdint>
#include <memory>
#include <random>
#include <stdexcept>
#include <utility>

#include "msgs/frames.h"
#include "runtime/vehicle/graph/vehicle.h"
#include "sensors/source.h"

namespace maploop::vehicle::testing {

constexpr Time drive_start = from_nanoseconds(1'317'042'651'000'000'000);

// Gives `count` samples; make(i, sample) fills the i-th.
template <class T, class Count, class Make>
std::unique_ptr<sensors::Source<T>> fake_source(Count count, Make make) {
  return sensors::made<T>([count = static_cast<std::uint64_t>(count), make](
                              T& sample, const sensors::SourceReport& report) {
    if (report.delivered == count) return false;
    sample.sequence = report.delivered;
    make(sample.sequence, sample);
    return true;
  });
}

inline VehicleCalibration fake_calibration() {
  VehicleCalibration calibration;
  StereoCalibration& c = calibration.stereo;
  c.width = 320;
  c.height = 120;
  c.fx = c.fy = 200.0;
  c.cx = 160.0;
  c.cy = 60.0;
  c.baseline = 0.5;
  c.T_body_cam.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return calibration;
}

inline Sensors fake_sensors(double seconds) {
  using std::chrono::milliseconds;
  Sensors s;
  s.camera = fake_source<StereoPair>(seconds * 10, [](std::uint64_t i, StereoPair& pair) {
    pair.stamp = drive_start + i * milliseconds(103);
    pair.available = pair.stamp + milliseconds(5);
    std::mt19937 random(static_cast<unsigned>(i));
    for (GreyImage* image : {&pair.left, &pair.right}) {
      image->resize(320, 120);
      for (auto& pixel : image->pixels) pixel = static_cast<std::uint8_t>(random() >> 24);
    }
  });
  s.velodyne = fake_source<LidarScan>(seconds * 10, [](std::uint64_t i, LidarScan& scan) {
    scan.stamp = drive_start + i * milliseconds(103);
    scan.start = scan.stamp - milliseconds(50);
    scan.available = scan.end = scan.stamp + milliseconds(50);
    scan.points.assign(100, {});
  });
  s.imu = fake_source<ImuSample>(seconds * 100, [](std::uint64_t i, ImuSample& sample) {
    sample.available = drive_start + i * milliseconds(10);
    sample.stamp = sample.available - milliseconds(60);
    sample.specific_force_forward = sample.specific_force_left = 0.0;
    sample.yaw_rate = 0.01 + 1e-9 * static_cast<double>(i);  // real values never repeat exactly
  });
  s.gnss = fake_source<GnssFix>(seconds, [](std::uint64_t i, GnssFix& fix) {
    fix.stamp = fix.available = drive_start + i * milliseconds(1000);
    fix.velocity_stamp = fix.stamp - milliseconds(60);
    fix.position = {radians(49.0), radians(8.4), 110.0};
    fix.position_covariance = Eigen::Matrix3d::Identity();
    fix.velocity_enu = {0.0, 10.0, 0.0};
    fix.velocity_covariance = 0.01 * Eigen::Matrix3d::Identity();
  });
  s.reference = fake_source<ReferencePose>(seconds * 10, [](std::uint64_t i, ReferencePose& pose) {
    pose.stamp = pose.available = drive_start + i * milliseconds(100);
  });
  return s;
}

// Throws an exception after `good` samples, as a broken driver would.
template <class T>
std::unique_ptr<sensors::Source<T>> broken(std::unique_ptr<sensors::Source<T>> source,
                                           std::uint64_t good) {
  return sensors::derived(std::move(source), [good](sensors::Source<T>& all, T& sample) {
    if (all.report().delivered == good) throw std::runtime_error("cable pulled");
    return all.next(sample);
  });
}

}  // namespace maploop::vehicle::testing
