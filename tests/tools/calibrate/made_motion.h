// Makes the motions of sensors on a car that turns, pitches and rolls in a known way.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <vector>

#include "msgs/small_turn.h"
#include "tests/support/drawn.h"
#include "tools/calibrate/extrinsics/rotation_stream.h"

namespace maploop::extrinsics {

// How much the car turns, pitches and rolls; rad/s.
struct MadeDrive {
  double seconds = 60.0, speed = 8.0;  // s, m/s
  double turns = 0.3, pitches = 0.02, rolls = 0.02;
  double axle = 1.5;  // m, of the body's origin ahead of the rear axle
};

class MadeMotion {
 public:
  explicit MadeMotion(const MadeDrive& drive = {}) : drive_(drive) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    const auto steps = static_cast<std::size_t>(drive.seconds / step);
    for (std::size_t i = 0; i <= steps; ++i) {
      poses_.push_back(T);
      const Eigen::Vector3d w = rate((static_cast<double>(i) + 0.5) * step);
      // The rear axle moves ahead alone; the body's origin is ahead of it.
      const Eigen::Vector3d v(drive.speed, drive.axle * w.z(), -drive.axle * w.y());
      T = T * Eigen::Translation3d(step * v) * Eigen::Quaterniond(rotation_of(step * w));
    }
  }

  // rad/s, in the body's axes.
  Eigen::Vector3d rate(double t) const {
    return {drive_.rolls * (std::sin(5.1 * t) + std::sin(8.3 * t + 1.0)),
            drive_.pitches * (std::sin(6.7 * t + 2.0) + std::sin(3.9 * t)),
            drive_.turns * std::sin(0.41 * t) * std::sin(0.13 * t + 0.5)};
  }

  // Returns the motions of a sensor whose stamps are late, with errors of 1 sigma (rad, m).
  std::vector<SensorMotion> of_sensor(const Eigen::Isometry3d& T_body_sensor, double late,
                                      double noise = 0.0, double error = 0.0,
                                      unsigned seed = 1) const {
    std::mt19937_64 engine(seed);
    std::normal_distribution<double> normal;
    const auto vector = [&] {
      return maploop::testing::drawn<Eigen::Vector3d>([&] { return normal(engine); });
    };
    std::vector<SensorMotion> motions;
    constexpr double period = 0.1;
    for (double t = 0.0; t + period < drive_.seconds - step; t += period) {
      Eigen::Isometry3d T = pose(t).inverse() * pose(t + period);
      T = T_body_sensor.inverse() * T * T_body_sensor;
      T.linear() = T.linear() * rotation_of(noise * vector());
      T.translation() += error * vector();
      motions.push_back({stamp(t + late), stamp(t + period + late), T});
    }
    return motions;
  }

  std::vector<RateSample> of_gyros(double late, double noise = 0.0,
                                   const Eigen::Vector3d& bias = Eigen::Vector3d::Zero()) const {
    std::mt19937_64 engine(7);
    std::normal_distribution<double> normal;
    std::vector<RateSample> samples;
    for (double t = 0.0; t < drive_.seconds; t += 0.01) {
      const Eigen::Vector3d wrong(normal(engine), normal(engine), normal(engine));
      samples.push_back({stamp(t + late), rate(t) + bias + noise * wrong});
    }
    return samples;
  }

 private:
  static constexpr double step = 0.002;  // s

  static Time stamp(double t) {
    return from_nanoseconds(1'600'000'000'000'000'000) + from_seconds(t);
  }
  const Eigen::Isometry3d& pose(double t) const {
    return poses_.at(static_cast<std::size_t>(std::lround(t / step)));
  }

  MadeDrive drive_;
  std::vector<Eigen::Isometry3d> poses_;
};

inline Eigen::Isometry3d placed(double x, double y, double z, const Eigen::Vector3d& turn) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = rotation_of(turn);
  T.translation() << x, y, z;
  return T;
}

}  // namespace maploop::extrinsics
