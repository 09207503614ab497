// How far the fused state is from the reference, and what it said of that itself.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "msgs/nav_state.h"
#include "msgs/reference.h"
#include "runtime/vehicle/drivers/gnss_outage.h"

namespace maploop::fusion_score {

// NAV_STATE as it was sent, every tenth: predicted to its tick, before the odometry of that moment
// had come. add() on one thread, the rest afterwards.
class NavTrack {
 public:
  // Returns whether it is kept.
  bool add(const NavState& state);
  const std::vector<NavState>& states() const { return states_; }
  // Returns for how long there was no state between the first one and `end`, s.
  double silent_until(Time end) const;

 private:
  std::vector<NavState> states_;
};

// A state and where the vehicle truly was.
struct ScoredState {
  const NavState* state;
  Eigen::Isometry3d truth;  // T_enu_body
  double accuracy;          // m, of the reference
};

// Horizontal, over one stretch. The normalized error squared (NEES) is of the horizontal position,
// two degrees of freedom, with the reference's own covariance added.
struct Errors {
  double distance = 0.0;     // m, of the reference
  double rmse = 0.0;         // m
  double max = 0.0;          // m
  double drift = 0.0;        // m, how the error changed from the begin to the end
  double azimuth_rms = 0.0;  // deg
  double azimuth_end = 0.0;  // deg
  double nees_mean = 0.0;
  double nees_end = 0.0;
  double nees_max = 0.0;
  // Longest time in one go in which the error was beyond three sigmas of the filter's own
  // (position: a NEES beyond a tail of 0.27 %).
  double beyond = 0.0;          // s
  double azimuth_beyond = 0.0;  // s
  double covered = 0.0;  // 1, share of the stretch where there is a reference that is good enough

  // Of the way: the drift, and the root of the mean error squared.
  double percent() const { return distance > 0.0 ? 100.0 * drift / distance : 0.0; }
  double rmse_percent() const { return distance > 0.0 ? 100.0 * rmse / distance : 0.0; }
};

struct OutageErrors {
  double start = 0.0, length = 0.0;  // s into the drive, s
  Errors errors;
};

// Where the reference says of itself that it is worse, nothing is scored: the error would be its
// own.
inline constexpr double worst_reference = 0.3;  // m

struct Score {
  double reference_accuracy = 0.0;  // m, median of what the reference says where it is scored
  Errors whole;
  std::vector<OutageErrors> outages;  // those that lie in the drive
  // Longest time for which position or azimuth was beyond three sigmas before anything was named.
  double unsaid = 0.0;  // s
  // Mean error of the continuous output over 100 m, %, after one rotation of the body is removed;
  // not a number where no stretch of the reference is that long.
  double odom_percent = 0.0;
};

// Returns the states for which there is a reference that is good enough. A reference that is
// nowhere better than worst_reference is taken as it is. They refer to the track.
std::vector<ScoredState> scored_states(const NavTrack& track,
                                       const std::vector<ReferencePose>& reference);

// Nothing where the track or the reference is too short. `named` is when HEALTH first said that
// something was wrong. `whole` and `unsaid` are of the time from `from` on.
std::optional<Score> score(const NavTrack& track, const std::vector<ReferencePose>& reference,
                           const std::vector<vehicle::GnssOutage>& outages, Time origin,
                           Time named = Time::max(), Time from = Time::min());

// Some lines for a terminal.
std::string to_text(const Score& score);

}  // namespace maploop::fusion_score
