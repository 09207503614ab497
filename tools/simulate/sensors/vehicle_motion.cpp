#include "tools/simulate/sensors/vehicle_motion.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "msgs/frames.h"
#include "tools/simulate/random.h"

namespace maploop::simulate {
namespace {

constexpr double nod = 0.004;   // rad per m/s^2, nose up when accelerating
constexpr double lean = 0.006;  // rad per m/s^2, outwards in curves

}  // namespace

VehicleMotion::VehicleMotion(std::shared_ptr<const LanePath> path,
                             std::shared_ptr<const SpeedProfile> profile, const Terrain& terrain,
                             std::uint64_t seed)
    : path_(std::move(path)), profile_(std::move(profile)), terrain_(terrain) {
  Random random(seed, 6);
  for (std::size_t i = 0; i < bumps_.size(); ++i) {
    const double length = 2.0 * std::pow(1.3, static_cast<double>(i)) * random.uniform(0.9, 1.1);
    bumps_[i] = {2.0 * std::numbers::pi / length, 0.0004 * length * random.uniform(0.5, 1.0),
                 radians(0.006) * length * random.uniform(-1.0, 1.0),
                 radians(0.006) * length * random.uniform(-1.0, 1.0),
                 random.uniform(0.0, 2.0 * std::numbers::pi)};
  }
}

Eigen::Isometry3d VehicleMotion::car_pose(double t) const {
  const double way = profile_->way(t), speed = profile_->speed(t);
  const Eigen::Vector2d p = path_->position(way), d = path_->derivative(way).normalized();
  const Eigen::Vector2d slope = terrain_.gradient(p), left(-d.y(), d.x());
  double height = terrain_.height(p) + origin_height;
  double pitch = std::atan(slope.dot(d)) + nod * profile_->acceleration(t);
  double roll = std::atan(slope.dot(left)) + lean * speed * speed * path_->curvature(way);
  for (const Bump& bump : bumps_) {
    const double phase = bump.number * way + bump.phase;
    height += bump.heave * std::sin(phase);
    pitch += bump.pitch * std::cos(phase);
    roll += bump.roll * std::sin(1.1 * phase);
  }
  Eigen::Isometry3d T_enu_car;
  const Attitude attitude{azimuth_from_yaw(std::atan2(d.y(), d.x())), pitch, roll};
  T_enu_car.linear() = rotation_enu_body(attitude);
  T_enu_car.translation() << p, height;
  return T_enu_car;
}

VehicleState VehicleMotion::state(double t) const {
  constexpr double h = 1e-3;  // s
  const Eigen::Isometry3d before = pose(t - h), after = pose(t + h);
  VehicleState state;
  state.T_enu_body = pose(t);
  state.velocity_enu = (after.translation() - before.translation()) / (2.0 * h);
  state.acceleration_enu =
      (after.translation() - 2.0 * state.T_enu_body.translation() + before.translation()) / (h * h);
  const Eigen::AngleAxisd turn(before.linear().transpose() * after.linear());
  state.rate_body = turn.angle() * turn.axis() / (2.0 * h);
  return state;
}

}  // namespace maploop::simulate
