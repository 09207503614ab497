#include "tools/calibrate/extrinsics/found_values.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "msgs/frames.h"
#include "msgs/small_turn.h"

namespace maploop::extrinsics {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;

// Returns roll, pitch and yaw, deg.
Vector3d angles_of(const Matrix3d& R_body_sensor, bool is_camera) {
  SensorPosition ignored;
  SensorRotation r;
  const Eigen::Isometry3d T(R_body_sensor);
  is_camera ? set_camera_pose(T, ignored, r) : set_sensor_pose(T, ignored, r);
  return {r.roll, r.pitch, r.yaw};
}

// Returns the standard deviations of the three angles, deg, by how they change with small turns.
Vector3d angle_sigmas(const Matrix3d& R_body_sensor, bool is_camera, const Matrix3d& covariance) {
  constexpr double small = 1e-5;  // rad
  Matrix3d J;
  for (int i = 0; i < 3; ++i) {
    const Vector3d turn = small * Vector3d::Unit(i);
    const Vector3d more = angles_of(rotation_of(turn) * R_body_sensor, is_camera);
    const Vector3d less = angles_of(rotation_of(-turn) * R_body_sensor, is_camera);
    for (int k = 0; k < 3; ++k)
      J(k, i) = degrees(wrap_angle(radians(more[k] - less[k]))) / (2.0 * small);
  }
  return (J * covariance * J.transpose()).diagonal().cwiseSqrt();
}

}  // namespace

std::string reason(const RateAlignment& r) {
  switch (r.status) {
    case AlignmentStatus::too_short:
      return "fewer than 6 s, or fewer than 20 motions, were measured by both";
    case AlignmentStatus::no_turning:
      return "the vehicle hardly turns";
    default:
      return fmt::format(
          "their rates of turn have a correlation of {:.2f} only, at any delay up to 0.5 s",
          r.correlation);
  }
}

FoundValues::FoundValues(const VehicleDescription& described) {
  found_.description = described;
}

void FoundValues::add(const SensorPair& pair) {
  found_.pairs.push_back(pair);
  if (pair.rates.status == AlignmentStatus::ok) return;
  say("Nothing is found of the " + pair.a + " against the " + pair.b + ": " + reason(pair.rates) +
      ".");
}

void FoundValues::put(const std::string& sensor, const char* unit, bool observed, const Change& c) {
  const std::string table = "vehicle." + sensor;
  std::erase_if(found_.values,
                [&](const FoundValue& v) { return v.table == table && v.key == c.key; });
  found_.values.push_back({table, c.key, unit, c.value, c.new_value, c.new_sigma, observed});
  if (!observed) {
    say(
        fmt::format("The {} of [vehicle.{}] is not observable on this recording (1 sigma {:.2g} "
                    "{}), and is not written.",
                    c.key, sensor, c.new_sigma, unit));
    return;
  }
  c.value = c.new_value;
  c.sigma = c.new_sigma;
}

void FoundValues::put_rotation(const std::string& sensor, SensorRotation& r,
                               const Matrix3d& R_body_sensor, const Matrix3d& covariance,
                               bool is_camera) {
  const Vector3d angles = angles_of(R_body_sensor, is_camera);
  const Vector3d sigmas = angle_sigmas(R_body_sensor, is_camera, covariance);
  // A unit's mount is used as a whole. Near a pitch of 90 degrees, its roll and yaw are uncertain
  // although the rotation is not.
  const bool all = covariance.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff() <=
                   std::pow(radians(observed_angle), 2);
  const auto put_angle = [&](const char* key, double& value, double& sigma, int i) {
    const bool observed = all || (sigmas[i] <= observed_angle && sensor != "imu");
    put(sensor, "deg", observed, {key, value, sigma, angles[i], std::min(sigmas[i], 180.0)});
  };
  put_angle("roll", r.roll, r.roll_sigma, 0);
  put_angle("pitch", r.pitch, r.pitch_sigma, 1);
  put_angle("yaw", r.yaw, r.yaw_sigma, 2);
}

void FoundValues::set_camera_rotation(const JointRotation& rotation) {
  put_rotation("camera", found_.description.camera.rotation, rotation.R_body_camera,
               rotation.covariance.topLeftCorner<3, 3>(), true);
  found_.contradiction = rotation.contradiction;
}

void FoundValues::set_lidar_rotation(const JointRotation& rotation) {
  put_rotation("lidar", found_.description.lidar.rotation, rotation.R_body_lidar,
               rotation.covariance.bottomRightCorner<3, 3>(), false);
  found_.contradiction = rotation.contradiction;
}

SensorTime& FoundValues::time_of(const std::string& sensor) {
  VehicleDescription& d = found_.description;
  return sensor == "camera" ? d.camera.time : sensor == "lidar" ? d.lidar.time : d.imu.time;
}

void FoundValues::set_delays(const std::string& compared_with,
                             const std::vector<MoreDelay>& found) {
  double negative = 0.0, sigma = 0.0;
  for (const MoreDelay& f : found) {
    const double delay = time_of(f.sensor).delay + f.more;
    if (f.sigma > observed_delay || delay > std::min(negative, -2.0 * f.sigma)) continue;
    negative = delay;
    sigma = f.sigma;
  }
  if (negative < 0.0) {
    SensorTime& t = time_of(compared_with);
    put(compared_with, "s", true, {"delay", t.delay, t.delay_sigma, t.delay - negative, sigma});
  }
  for (const MoreDelay& f : found) {
    SensorTime& t = time_of(f.sensor);
    put(f.sensor, "s", f.sigma <= observed_delay,
        {"delay", t.delay, t.delay_sigma, std::max(0.0, t.delay + f.more - negative), f.sigma});
  }
}

void FoundValues::set_forward(const std::string& sensor, const Travel& travel) {
  if (!travel.found) return;
  const CarDescription& car = found_.description.car;
  VehicleDescription& d = found_.description;
  SensorPosition& p = sensor == "camera" ? d.camera.position : d.lidar.position;
  const double sigma = std::hypot(travel.axle_distance_sigma, car.rear_axle_distance_sigma);
  put(sensor, "m", sigma <= observed_position,
      {"forward", p.forward, p.forward_sigma, travel.axle_distance - car.rear_axle_distance,
       sigma});
}

void FoundValues::set_lidar_position(const HandEye& eye, const JointRotation& rotation) {
  SensorPosition &camera = found_.description.camera.position,
                 &lidar = found_.description.lidar.position;
  const Matrix3d& R = rotation.R_body_camera;
  const Vector3d apart = R * eye.T_a_b.translation();
  const Matrix3d spread = R * eye.position_sigma.cwiseAbs2().asDiagonal() * R.transpose();
  const auto put_axis = [&](const char* key, double SensorPosition::*value,
                            double SensorPosition::*value_sigma, int axis) {
    const bool camera_moves = lidar.*value_sigma < camera.*value_sigma;
    SensorPosition &stays = camera_moves ? lidar : camera, &moves = camera_moves ? camera : lidar;
    const double sigma = std::sqrt(spread(axis, axis));
    put(camera_moves ? "camera" : "lidar", "m", sigma <= observed_position,
        {key, moves.*value, moves.*value_sigma,
         stays.*value + (camera_moves ? -1.0 : 1.0) * apart[axis],
         std::hypot(sigma, stays.*value_sigma)});
  };
  put_axis("forward", &SensorPosition::forward, &SensorPosition::forward_sigma, 0);
  put_axis("left", &SensorPosition::left, &SensorPosition::left_sigma, 1);
  put_axis("up", &SensorPosition::up, &SensorPosition::up_sigma, 2);
}

void FoundValues::set_mount(const sensors::Mount& mount) {
  if (mount.status != sensors::MountStatus::found) {
    say("How the inertial unit is turned in the vehicle is not found: that needs a minute of "
        "driving with turns and braking, and the fixes of a GNSS receiver.");
    return;
  }
  // The level is known about the vehicle's horizontal axes, the forward direction about its third.
  // A constant error of the accelerometers looks like a slope.
  constexpr double accelerometer_error = 0.01;  // of gravity, 0.1 m/s^2 of a unit of chips
  const double level = std::hypot(mount.level_sigma, accelerometer_error);
  const Vector3d sigma(level, level, mount.forward_sigma);
  put_rotation("imu", found_.description.imu.rotation, mount.R_body_unit,
               sigma.cwiseAbs2().asDiagonal(), false);
  say_turning_axis(mount);
}

// The level by the gyros alone is compared with that by gravity.
void FoundValues::say_turning_axis(const sensors::Mount& mount) {
  const sensors::TurningAxis::Line& turning = mount.turning;
  if (turning.sigma > radians(observed_angle)) return;
  const Vector3d level = mount.R_body_unit.row(2).transpose();
  const auto between = Eigen::Quaterniond::FromTwoVectors(turning.axis, level);
  const double angle = 2.0 * std::atan2(between.vec().norm(), std::abs(between.w()));
  const Vector3d angles = angles_of(mount.R_body_unit * between, false);
  say(fmt::format(
      "By the axis about which the gyros turn, roll is {:.1f} and pitch {:.1f} deg (sigma {:.1f}), "
      "{:.1f} deg from the level that gravity shows. The latter contains a constant error of the "
      "accelerometers ({:.2f} m/s^2 would be that much) and is what is written.",
      angles[0], angles[1], degrees(turning.sigma), degrees(angle), 9.81 * std::sin(angle)));
}

}  // namespace maploop::extrinsics
