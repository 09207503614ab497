// This file finds how an inertial unit is mounted in a vehicle from what the unit and a GNSS
// receiver measure on the way.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "msgs/gnss.h"
#include "msgs/imu.h"
#include "msgs/named_enum.h"
#include "sensors/imu/turning_axis.h"

namespace maploop::sensors {

// Holds a sample of three gyros and three accelerometers in the unit's own axes.
struct SixAxisSample : Sample {
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();   // rad/s
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  // m/s^2, +9.8 along an axis that points up
};

struct MountParameters {
  bool given = false;  // the angles below are the mount, and none is looked for
  double roll = 0.0;   // deg, R_body_unit = Rz(yaw) Ry(pitch) Rx(roll)
  double pitch = 0.0;  // deg
  double yaw = 0.0;    // deg
};

enum class MountStatus : std::uint8_t { searching, found, given };

constexpr auto names_of(MountStatus) {
  return names_up_to<MountStatus::given>({"searching", "found", "given"});
}

struct Mount {
  MountStatus status = MountStatus::searching;
  Eigen::Matrix3d R_body_unit = Eigen::Matrix3d::Identity();  // the best so far
  // These are rad, 1 sigma. The level is the apparent one: the force of a vehicle that stands level
  // points upwards, so that constant horizontal biases of the accelerometers are a part of it.
  double level_sigma = 3.2;
  double forward_sigma = 3.2;
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();  // rad/s, in the unit's axes
  TurningAxis::Line turning;    // the vertical of the unit by its gyros; the level does not use it
  std::uint64_t intervals = 0;  // of motion that it was found from

  bool known() const { return status != MountStatus::searching; }
};

// Between two fixes of a moving receiver, the change of its velocity and gravity give the specific
// force in the body's axes: forward is along the velocity, and the climb is the velocity's. The
// mount is the rotation that takes the unit's mean force of each interval closest to it, with the
// sum of squares weighted (Wahba, "A least squares estimate of satellite attitude", SIAM Review 7,
// 1965; solved as Markley, J. Astronautical Sciences 36, 1988). Gravity levels it, turns and
// braking give its forward axis, and no direction is ambiguous. It is found when the forward axis
// is known to a degree, and is refined for as long as there are fixes. The gyros' bias is their
// mean at rest, or else what they turned more than the course; it is kept once the mount is known.
//
// Not thread-safe. Samples and fixes each come in the order of their stamps; the result depends on
// them alone. The memory is that of 1024 samples, whatever the length of the drive.
class MountAlignment {
 public:
  // `rear_axle_distance` (m) is how far the unit and the antenna are ahead of the rear axle: by it,
  // their course leads the body's azimuth in turns.
  explicit MountAlignment(const MountParameters& parameters, double rear_axle_distance = 0.0);

  void add(const SixAxisSample& sample);
  void add(const GnssFix& fix);

  const Mount& mount() const { return mount_; }

  // Returns the sample in the body's axes, without the gyros' bias.
  ImuSample aligned(const SixAxisSample& sample) const;

 private:
  // These are the rate, the force, and the square of the rate.
  using Values = Eigen::Matrix<double, 7, 1>;
  struct Entry {
    Time stamp{};
    Values value = Values::Zero();
    Values integral = Values::Zero();  // over time since the first sample
  };
  struct Motion;

  const Entry& entry(std::size_t i) const { return ring_[(first_ + i) % ring_.size()]; }
  std::optional<Values> integral_at(Time t) const;
  void take_pending();
  void learn(const GnssFix& a, const GnssFix& b);
  void learn_rest(const Values& mean, double duration);
  void learn_motion(const Motion& motion);
  void settle();

  double rear_axle_distance_;
  Mount mount_;
  std::vector<Entry> ring_;
  std::size_t first_ = 0, count_ = 0;
  std::optional<GnssFix> pending_, previous_;

  double rest_ = 0.0;                                  // s
  Eigen::Matrix3d profile_ = Eigen::Matrix3d::Zero();  // weighted sum of body times unit force
  TurningAxis turning_;
  double weights_ = 0.0, residuals_ = 0.0, horizontal_ = 0.0;  // weighted sums, 1 and m^2/s^4
};

}  // namespace maploop::sensors
