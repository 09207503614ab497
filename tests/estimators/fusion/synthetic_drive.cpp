#include "tests/estimators/fusion/synthetic_drive.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "msgs/frames.h"
#include "tests/support/drawn.h"

namespace maploop::testing {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double step = 1e-3;   // s
constexpr double margin = 1.0;  // s, before the start and after the end
constexpr double gravity = 9.809;
constexpr double earth_rate = 7.292115e-5;

template <class Value>
Value interpolate(const std::vector<Value>& values, double t) {
  const double place = std::clamp((t + margin) / step, 0.0, static_cast<double>(values.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(place), values.size() - 2);
  return values[i] + (place - static_cast<double>(i)) * (values[i + 1] - values[i]);
}

}  // namespace

Geodetic test_origin() {
  return {radians(49.0), radians(8.4), 115.0};
}

SyntheticDrive::SyntheticDrive(const MotionProfile& profile, double duration,
                               const Geodetic& origin)
    : profile_(profile), duration_(duration), origin_(origin) {
  const auto total = static_cast<std::size_t>(std::lround((duration + 2.0 * margin) / step)) + 1;
  const auto start = static_cast<std::size_t>(std::lround(margin / step));
  positions_.resize(total);
  azimuths_.resize(total);
  positions_[start].setZero();
  azimuths_[start] = profile.azimuth;
  const auto integrate = [&](std::size_t from, std::size_t to) {
    const double dt = to > from ? step : -step;
    const double mid = static_cast<double>(from) * step - margin + 0.5 * dt;
    const double turn = -dt * profile.yaw_rate(mid);
    const double azimuth = azimuths_[from] + 0.5 * turn;
    const double pitch = profile.pitch(mid);
    const double ds = dt * profile.speed(mid);
    positions_[to] =
        positions_[from] + ds * Vector3d(std::sin(azimuth) * std::cos(pitch),
                                         std::cos(azimuth) * std::cos(pitch), std::sin(pitch));
    azimuths_[to] = azimuths_[from] + turn;
  };
  for (std::size_t i = start; i + 1 < total; ++i) integrate(i, i + 1);
  for (std::size_t i = start; i > 0; --i) integrate(i, i - 1);
}

Time SyntheticDrive::at(double seconds) {
  return parse_time("2011-09-26 13:00:00") + from_seconds(seconds);
}

double SyntheticDrive::azimuth(double t) const {
  return wrap_angle(interpolate(azimuths_, t));
}

Eigen::Isometry3d SyntheticDrive::pose(double t) const {
  return Eigen::Translation3d(interpolate(positions_, t)) *
         Eigen::Quaterniond(rotation_enu_body({azimuth(t), pitch(t), roll(t)}));
}

Vector3d SyntheticDrive::velocity(double t) const {
  return speed(t) * pose(t).rotation().col(0);
}

std::vector<ImuSample> SyntheticDrive::imu(double rate, const SensorNoise& noise) const {
  std::mt19937 random(noise.seed);
  std::normal_distribution<double> normal;
  const Vector3d earth(0.0, earth_rate * std::cos(origin_.latitude),
                       earth_rate * std::sin(origin_.latitude));
  constexpr double h = 2e-3;  // s, for the derivatives of velocity and attitude
  std::vector<ImuSample> samples;
  for (int i = 0; i <= static_cast<int>(std::lround(duration_ * rate)); ++i) {
    const double t = i / rate;
    const Matrix3d R = pose(t).rotation();
    const Vector3d acceleration = (velocity(t + h) - velocity(t - h)) / (2 * h);
    const Matrix3d R_dot = (pose(t + h).rotation() - pose(t - h).rotation()) / (2 * h);
    const Matrix3d turn = R.transpose() * R_dot;
    const Vector3d force = R.transpose() * (acceleration + Vector3d(0.0, 0.0, gravity));
    ImuSample s;
    s.stamp = s.available = at(t);
    s.sequence = static_cast<std::uint64_t>(i);
    s.specific_force_forward = force.x() + noise.force_sigma * normal(random);
    s.specific_force_left = force.y() + noise.force_sigma * normal(random);
    // Even an excellent sensor never repeats its values exactly.
    s.yaw_rate = 0.5 * (turn(1, 0) - turn(0, 1)) + R.col(2).dot(earth) + noise.gyro_bias +
                 1e-9 * (i % 2) + noise.gyro_density * std::sqrt(rate) * normal(random);
    s.six_axes = true;
    s.specific_force_up = force.z();
    s.roll_rate = 0.5 * (turn(2, 1) - turn(1, 2)) + R.col(0).dot(earth) + noise.tilt_gyro_bias;
    s.pitch_rate = 0.5 * (turn(0, 2) - turn(2, 0)) + R.col(1).dot(earth) - noise.tilt_gyro_bias;
    samples.push_back(s);
  }
  return samples;
}

std::vector<RelativeMotion> SyntheticDrive::odometry(double rate, const SensorNoise& noise) const {
  std::mt19937 random(noise.seed + 1000);
  std::normal_distribution<double> normal;
  const auto noise_vector = [&](double sigma) {
    return maploop::testing::drawn<Vector3d>([&] { return sigma * normal(random); });
  };
  std::vector<RelativeMotion> motions;
  for (int i = 1; i <= static_cast<int>(std::lround(duration_ * rate)); ++i) {
    const double from = (i - 1) / rate;
    const double to = i / rate;
    const double translation_sigma = noise.odometry_speed_sigma / rate;
    const Eigen::Isometry3d T = pose(from).inverse() * pose(to);
    const Vector3d turn = noise_vector(noise.odometry_rotation_sigma);
    RelativeMotion m;
    m.status = OdometryStatus::ok;
    m.from = at(from);
    m.stamp = at(to);
    m.available = m.stamp + from_seconds(0.08);
    m.sequence = static_cast<std::uint64_t>(i);
    m.translation = T.translation() + noise_vector(translation_sigma);
    const double angle = turn.norm();
    m.rotation = (angle > 0.0 ? Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle))
                              : Eigen::Quaterniond::Identity()) *
                 Eigen::Quaterniond(T.rotation());
    m.covariance.diagonal().head<3>().setConstant(translation_sigma * translation_sigma);
    m.covariance.diagonal().tail<3>().setConstant(noise.odometry_rotation_sigma *
                                                  noise.odometry_rotation_sigma);
    motions.push_back(m);
  }
  return motions;
}

std::vector<WheelSpeed> SyntheticDrive::wheels(double from, double to, double scale) const {
  std::vector<WheelSpeed> samples;
  for (std::uint64_t i = 0; from + 0.1 * static_cast<double>(i) < to; ++i) {
    const double t = from + 0.1 * static_cast<double>(i);
    WheelSpeed w;
    w.stamp = at(t);
    w.available = w.stamp + from_seconds(0.02);
    w.sequence = i;
    w.speed = (1.0 + scale) * speed(t);
    w.sigma = 0.05;
    samples.push_back(w);
  }
  return samples;
}

GnssFix SyntheticDrive::fix(double t, double velocity_delay) const {
  GnssFix fix;
  fix.stamp = fix.available = at(t);
  fix.position = LocalFrame(origin_).to_geodetic(pose(t).translation());
  fix.position_covariance = Eigen::Matrix3d::Identity();
  fix.velocity_stamp = at(t - velocity_delay);
  fix.velocity_enu = velocity(t - velocity_delay);
  fix.velocity_covariance = 0.01 * Eigen::Matrix3d::Identity();
  return fix;
}

}  // namespace maploop::testing
