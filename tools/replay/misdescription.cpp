#include "tools/replay/misdescription.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "msgs/frames.h"
#include "sensors/source.h"

namespace maploop::tools {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

// Changes each sample of a source, if it is there.
template <class T, class Change>
void change_each(std::unique_ptr<sensors::Source<T>>& source, Change change) {
  if (source == nullptr) return;
  source = sensors::derived(std::move(source), [change](sensors::Source<T>& all, T& sample) {
    if (!all.next(sample)) return false;
    change(sample);
    return true;
  });
}

// A stamp that is late by itself comes late as well: it is that of the arrival.
void shift(Sample& sample, Duration by) {
  sample.stamp += by;
  sample.available += std::max(by, Duration::zero());
}

void turn(ImuSample& sample, const Eigen::Matrix3d& R) {
  constexpr double gravity = 9.81;  // m/s^2, what a reduced unit does not measure
  const Vector3d force = R * Vector3d(sample.specific_force_forward, sample.specific_force_left,
                                      sample.six_axes ? sample.specific_force_up : gravity);
  const Vector3d rate = R * Vector3d(sample.roll_rate, sample.pitch_rate, sample.yaw_rate);
  sample.specific_force_forward = force.x();
  sample.specific_force_left = force.y();
  sample.yaw_rate = rate.z();
  if (!sample.six_axes) return;
  sample.specific_force_up = force.z();
  sample.roll_rate = rate.x();
  sample.pitch_rate = rate.y();
}

// X turns and moves the right pose of the camera, in the body's axes, to the described one.
void move(RelativeMotion& motion, const Eigen::Isometry3d& X) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = motion.rotation.toRotationMatrix();
  T.translation() = motion.translation;
  T = X * T * X.inverse();
  motion.rotation = Eigen::Quaterniond(T.linear()).normalized();
  motion.translation = T.translation();
}

}  // namespace

Property property_named(const std::string& name) {
  if (const auto property = value_named<Property>(name)) return *property;
  std::string all;
  for (const std::string_view known : enum_names<Property>)
    all += (all.empty() ? "" : ", ") + std::string(known);
  throw std::invalid_argument("no property of the car is called '" + name + "'; there are " + all);
}

Misdescription misdescription(Property property, std::int64_t seed) {
  constexpr double place = 0.5;           // m
  constexpr double angle = radians(1.0);  // rad
  constexpr auto late = std::chrono::milliseconds(30);
  std::mt19937_64 random(static_cast<std::uint64_t>(seed));
  const auto sign = [&] { return (random() >> 63) != 0 ? 1 : -1; };
  const auto horizontal = [&] {
    const double a = std::ldexp(static_cast<double>(random() >> 11), -53) * 2.0 * std::numbers::pi;
    return Vector3d(std::cos(a), std::sin(a), 0.0);
  };
  Misdescription wrong;
  wrong.antenna = place * horizontal();
  wrong.camera_place = place * horizontal();
  const std::array yaw_pitch_roll{sign() * angle, sign() * angle, sign() * angle};
  wrong.mount = (AngleAxisd(yaw_pitch_roll[0], Vector3d::UnitZ()) *
                 AngleAxisd(yaw_pitch_roll[1], Vector3d::UnitY()) *
                 AngleAxisd(yaw_pitch_roll[2], Vector3d::UnitX()))
                    .toRotationMatrix();
  wrong.camera_yaw = sign() * angle;
  wrong.axle = sign() * place;
  wrong.imu_stamps = sign() * late;
  wrong.gnss_stamps = sign() * late;
  wrong.camera_stamps = sign() * late;
  const Misdescription right;
  const auto is_right = [property](Property of) {
    return property != of && property != Property::everything;
  };
  if (is_right(Property::antenna)) wrong.antenna = right.antenna;
  if (is_right(Property::mount)) wrong.mount = right.mount;
  if (is_right(Property::camera)) {
    wrong.camera_place = right.camera_place;
    wrong.camera_yaw = right.camera_yaw;
  }
  if (is_right(Property::axle)) wrong.axle = right.axle;
  if (is_right(Property::imu_stamps)) wrong.imu_stamps = right.imu_stamps;
  if (is_right(Property::gnss_stamps)) wrong.gnss_stamps = right.gnss_stamps;
  if (is_right(Property::camera_stamps)) wrong.camera_stamps = right.camera_stamps;
  return wrong;
}

void misdescribe(vehicle::VehicleConfig& config, vehicle::Recording& recording,
                 const Misdescription& wrong) {
  const vehicle::Sensors recorded = recording.sensors(Time::max());
  if (recorded.camera != nullptr || recorded.velodyne != nullptr) {
    throw std::runtime_error(
        "--misdescribe: the recording has images or scans; replay the log of its odometry, which "
        "'maploop replay DRIVE --record FILE' writes");
  }
  vehicle::VehicleConfig known = config;
  describe_car(known, recording.calibration);
  config.vehicle = known.vehicle;
  SensorPosition& antenna = config.vehicle.antenna.position;
  antenna.forward += wrong.antenna.x();
  antenna.left += wrong.antenna.y();
  antenna.up += wrong.antenna.z();
  config.vehicle.car.rear_axle_distance += wrong.axle;
  for (const std::string key : {"vehicle.antenna.forward", "vehicle.antenna.left",
                                "vehicle.antenna.up", "vehicle.rear_axle_distance"}) {
    config.given.insert(key);
    config.given.erase(key + "_sigma");
  }
  if (!config.is_given("fusion", "gnss_lever_sigma"))
    config.fusion.gnss_lever_sigma = fusion::FusionParameters{}.gnss_lever_sigma;
  recording.sensors = [right = std::move(recording.sensors), wrong,
                       calibration = recording.calibration](Time passed) {
    vehicle::Sensors sensors = right(passed);
    misdescribe(sensors, wrong, calibration);
    return sensors;
  };
}

void misdescribe(vehicle::Sensors& sensors, const Misdescription& wrong,
                 const VehicleCalibration& calibration) {
  change_each(sensors.imu, [wrong](ImuSample& sample) {
    turn(sample, wrong.mount);
    shift(sample, wrong.imu_stamps);
  });
  change_each(sensors.gnss, [wrong](GnssFix& fix) {
    shift(fix, wrong.gnss_stamps);
    fix.velocity_stamp += wrong.gnss_stamps;
  });
  const Vector3d camera = calibration.stereo.T_body_cam.translation();
  const Eigen::Isometry3d X = Eigen::Translation3d(camera + wrong.camera_place) *
                              AngleAxisd(wrong.camera_yaw, Vector3d::UnitZ()) *
                              Eigen::Translation3d(-camera);
  const auto change = [X, by = wrong.camera_stamps](RelativeMotion& motion) {
    move(motion, X);
    shift(motion, by);
    motion.from += by;
  };
  change_each(sensors.odometry, change);
  change_each(sensors.visual, change);
}

}  // namespace maploop::tools
