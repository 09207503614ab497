// Computes how far the fused position may be wrong, also where one of its aids is.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "estimators/fusion/guarded_filter.h"
#include "estimators/fusion/protection_parameters.h"
#include "msgs/gnss.h"
#include "msgs/nav_protection.h"
#include "msgs/odom_state.h"

namespace maploop::fusion {

// A level is where the probabilities of the faults add up to the risk (solution separation; Blanch
// et al., "Baseline advanced RAIM user algorithm and possible improvements", IEEE Transactions on
// Aerospace and Electronic Systems 51, 2015). The positions without an aid cost no filter of their
// own: that without the map is a copy of the guard, that without GNSS is odometry's way from where
// the vehicle was a while ago, and that without odometry is a median of fixes.
//
// Not thread-safe. Allocates nothing.
class ProtectionMonitor {
 public:
  // Throws std::invalid_argument if a parameter is out of its bounds.
  explicit ProtectionMonitor(const ProtectionParameters& parameters = {});

  // Notes how far a fix is from the filter, which has used it or found it too far away.
  void note(const GnssFix& fix, const ReducedImuFilter& filter);

  // Returns the levels of `state`, an initialized one; to be called about every 0.1 s.
  NavProtection levels(const FusedState& state, const GuardedFilter& filter);

  static constexpr std::size_t largest_archive() { return sizeof(ProtectionMonitor) + 4096; }
  // Loading throws ArchiveError if the archive is broken, of another version, or of other
  // parameters.
  void archive(ArchiveWriter& ar) const;
  void archive(ArchiveReader& ar);

 private:
  // Where the vehicle was by both outputs. The covariance is of east, north (m) and azimuth (rad).
  struct Past {
    Time stamp{};
    Eigen::Vector2d position = Eigen::Vector2d::Zero(), odom = Eigen::Vector2d::Zero();
    double azimuth = 0.0, odom_azimuth = 0.0;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    double way = 0.0;

    void archive(auto& ar) { ar(stamp, position, odom, azimuth, odom_azimuth, covariance, way); }
  };
  struct Fix {
    Time stamp{};
    Eigen::Vector2d apart = Eigen::Vector2d::Zero();  // m, from the fused position to the fix
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();

    void archive(auto& ar) { ar(stamp, apart, covariance); }
  };
  // A position without an aid, from the fused one, and the covariance of its error.
  struct Alternative {
    Eigen::Vector2d apart;
    Eigen::Matrix2d covariance;
  };

  template <class Archive, class Monitor>
  static void describe(Archive& ar, Monitor& monitor);
  void follow(const FusedState& state);
  Eigen::Matrix2d with_model(const Eigen::Matrix2d& covariance, double way) const;
  std::optional<Alternative> without_map(const FusedState& state,
                                         const GuardedFilter& filter) const;
  std::optional<Alternative> without_gnss(const FusedState& state) const;
  std::optional<Alternative> without_odometry(const FusedState& state) const;

  ProtectionParameters parameters_;
  static constexpr std::size_t most_pasts = 31, most_fixes = 16;
  std::array<Past, most_pasts> pasts_;  // the oldest first
  std::array<Fix, most_fixes> fixes_;
  std::size_t past_count_ = 0, fix_count_ = 0;
  Time last_{};
  std::uint64_t reinitializations_ = 0;
  Time gnss_stamp_{};
  double way_ = 0.0, way_at_fix_ = 0.0;  // m
};

}  // namespace maploop::fusion
