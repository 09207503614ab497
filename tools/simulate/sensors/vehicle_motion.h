// Computes the vehicle's pose as a function of time.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>

#include "tools/simulate/sensors/speed_profile.h"
#include "tools/simulate/town/lane_path.h"
#include "tools/simulate/town/terrain.h"

namespace maploop::simulate {

// The exact state at the body's origin, which an inertial unit there would measure.
struct VehicleState {
  Eigen::Isometry3d T_enu_body = Eigen::Isometry3d::Identity();
  Eigen::Vector3d velocity_enu = Eigen::Vector3d::Zero();      // m/s
  Eigen::Vector3d acceleration_enu = Eigen::Vector3d::Zero();  // m/s^2
  Eigen::Vector3d rate_body = Eigen::Vector3d::Zero();         // rad/s
};

// The car's origin, above the rear axle, follows the path and points along it. The car lies
// on the terrain, pitches and rolls on its springs with its accelerations, and shakes with the
// unevenness of the road. Times are seconds from the start of the drive.
class VehicleMotion {
 public:
  static constexpr double origin_height = 0.93;  // m, of the car's origin above the road

  VehicleMotion(std::shared_ptr<const LanePath> path, std::shared_ptr<const SpeedProfile> profile,
                const Terrain& terrain, std::uint64_t seed);

  // Says where the body is in the car; otherwise it is the car's own.
  void set_body(const Eigen::Isometry3d& T_car_body) { T_car_body_ = T_car_body; }

  Eigen::Isometry3d pose(double t) const { return car_pose(t) * T_car_body_; }  // T_enu_body
  // Velocities and accelerations are central differences over 2 ms.
  VehicleState state(double t) const;

  // Returns where the car's origin is.
  Eigen::Vector2d position(double t) const { return path_->position(profile_->way(t)); }
  const LanePath& path() const { return *path_; }
  double way(double t) const { return profile_->way(t); }  // m along the path

 private:
  struct Bump {
    double number, heave, pitch, roll, phase;  // rad/m, m, rad, rad, rad
  };

  Eigen::Isometry3d car_pose(double t) const;

  Eigen::Isometry3d T_car_body_ = Eigen::Isometry3d::Identity();
  std::shared_ptr<const LanePath> path_;
  std::shared_ptr<const SpeedProfile> profile_;
  Terrain terrain_;
  std::array<Bump, 10> bumps_;
};

}  // namespace maploop::simulate
