// Defines small synthetic sensors. The graph does not need realistic images, so these are plain
// noise, which costs little and which the odometry refuses by name.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <stdexcept>
#include <utility>

#include "msgs/frames.h"
#include "runtime/vehicle/graph/vehicle.h"
#include "sensors/source.h"

namespace maploop::vehicle::testing {

constexpr Time drive_start = from_nanoseconds(1'317'042'651'000'000'000);

// A FakeSource gives `count` samples; make(i, sample) fills the i-th.
template <class T>
class FakeSource final : public sensors::Source<T> {
 public:
  FakeSource(std::uint64_t count, std::function<void(std::uint64_t, T&)> make)
      : count_(count), make_(std::move(make)) {}

  bool next(T& sample) override {
    if (report_.delivered == count_) return false;
    sample.sequence = report_.delivered;
    make_(report_.delivered++, sample);
    return true;
  }
  const sensors::SourceReport& report() const override { return report_; }

 private:
  std::uint64_t count_;
  std::function<void(std::uint64_t, T&)> make_;
  sensors::SourceReport report_;
};

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
  s.camera = std::make_unique<FakeSource<StereoPair>>(
      static_cast<std::uint64_t>(seconds * 10), [](std::uint64_t i, StereoPair& pair) {
        pair.stamp = drive_start + i * milliseconds(103);
        pair.available = pair.stamp + milliseconds(5);
        std::mt19937 random(static_cast<unsigned>(i));
        for (GreyImage* image : {&pair.left, &pair.right}) {
          image->resize(320, 120);
          for (auto& pixel : image->pixels) pixel = static_cast<std::uint8_t>(random() >> 24);
        }
      });
  s.velodyne = std::make_unique<FakeSource<LidarScan>>(
      static_cast<std::uint64_t>(seconds * 10), [](std::uint64_t i, LidarScan& scan) {
        scan.stamp = drive_start + i * milliseconds(103);
        scan.start = scan.stamp - milliseconds(50);
        scan.available = scan.end = scan.stamp + milliseconds(50);
        scan.points.assign(100, {});
      });
  s.imu = std::make_unique<FakeSource<ImuSample>>(
      static_cast<std::uint64_t>(seconds * 100), [](std::uint64_t i, ImuSample& sample) {
        sample.available = drive_start + i * milliseconds(10);
        sample.stamp = sample.available - milliseconds(60);
        sample.specific_force_forward = sample.specific_force_left = 0.0;
        sample.yaw_rate = 0.01 + 1e-9 * static_cast<double>(i);  // real values never repeat exactly
      });
  s.gnss = std::make_unique<FakeSource<GnssFix>>(
      static_cast<std::uint64_t>(seconds), [](std::uint64_t i, GnssFix& fix) {
        fix.stamp = fix.available = drive_start + i * milliseconds(1000);
        fix.velocity_stamp = fix.stamp - milliseconds(60);
        fix.position = {radians(49.0), radians(8.4), 110.0};
        fix.position_covariance = Eigen::Matrix3d::Identity();
        fix.velocity_enu = {0.0, 10.0, 0.0};
        fix.velocity_covariance = 0.01 * Eigen::Matrix3d::Identity();
      });
  s.reference = std::make_unique<FakeSource<ReferencePose>>(
      static_cast<std::uint64_t>(seconds * 10), [](std::uint64_t i, ReferencePose& pose) {
        pose.stamp = pose.available = drive_start + i * milliseconds(100);
      });
  return s;
}

// A BrokenSource throws an exception after `good` samples, as a broken driver would.
template <class T>
class BrokenSource final : public sensors::Source<T> {
 public:
  BrokenSource(std::unique_ptr<sensors::Source<T>> source, std::uint64_t good)
      : source_(std::move(source)), good_(good) {}
  bool next(T& sample) override {
    if (source_->report().delivered == good_) throw std::runtime_error("cable pulled");
    return source_->next(sample);
  }
  const sensors::SourceReport& report() const override { return source_->report(); }

 private:
  std::unique_ptr<sensors::Source<T>> source_;
  std::uint64_t good_;
};

}  // namespace maploop::vehicle::testing
