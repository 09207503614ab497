// This file follows the antenna by the fused states, for the ppp thread.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "estimators/fusion/fusion_parameters.h"
#include "msgs/local_frame.h"
#include "msgs/odom_state.h"
#include "ppp/carried_motion.h"

namespace maploop::vehicle {

// Where the antenna was, and how it moved, by one fused state.
struct AntennaMoment {
  Time stamp{}, available{};
  Geodetic origin;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();     // m, of the antenna in the odometry frame
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // m/s, the same
  Eigen::Matrix3d R_enu_odom = Eigen::Matrix3d::Identity();
  double azimuth = 0.0;        // rad, in the odometry frame
  double azimuth_sigma = 0.0;  // rad, in enu

  void archive(auto& ar) {
    ar(stamp, available, origin, place, velocity, R_enu_odom, azimuth, azimuth_sigma);
  }
};

// Says how the antenna moved from one epoch of the receiver to the next one by the odometry frame,
// which fixes do not move, turned as the map frame is at the later epoch. There is no motion where
// neither odometry nor wheels nor a standstill have been measured for half a second: the fused
// speed then is that of the fixes themselves.
class AntennaTrack {
 public:
  explicit AntennaTrack(const fusion::FusionParameters& parameters)
      : lever_(parameters.gnss_lever_forward, parameters.gnss_lever_left, parameters.gnss_lever_up),
        lever_sigma_(parameters.gnss_lever_sigma) {
    moments_.reserve(capacity);
  }

  // States come in the order of their stamps. Those before the newest epoch are forgotten, and more
  // than `capacity` of them, of 2.5 s.
  void add(const FusedState& state);

  // Returns the motion since the stamp of the call before to `stamp`, by the states that are
  // available by `available`; nothing if one of both ends is not known.
  std::optional<ppp::CarriedMotion> motion_to(Time stamp, Time available);

  static constexpr std::size_t capacity = 256;
  static constexpr std::size_t largest_archive = (capacity + 2) * sizeof(AntennaMoment);

  // Those that are available at the cut.
  template <class Archive>
  void archive(Archive& ar, Time cut) {
    std::vector<Moment> known;
    for (const Moment& m : moments_)
      if (m.available <= cut) known.push_back(m);
    ar(known, last_);
    if constexpr (Archive::loading) moments_.assign(known.begin(), known.end());
  }

 private:
  using Moment = AntennaMoment;

  std::optional<Moment> at(Time stamp, Time available) const;

  Eigen::Vector3d lever_;  // m, in the body's axes
  double lever_sigma_;     // m
  std::vector<Moment> moments_;
  std::optional<Moment> last_;  // at the epoch before
};

}  // namespace maploop::vehicle
