// This is the Kalman filter of one path hypothesis: its position along the path, and the fixes'
// offset from it.
//
// The state is s (m along the link, as driven) and the offset (m, east and north) of the fixes from
// the road. The offset consists of the map's error and the slow part of the fixes' errors: a
// Gauss-Markov process of parameters.correlation_time. The distance travelled predicts the state;
// the fixes correct it, and so do their azimuths in bends. Each misfit lowers the hypothesis's log
// weight. METHOD.md has the equations. Does not allocate.
#pragma once

#include <Eigen/Core>

#include "mapmatch/match_parameters.h"
#include "mapmatch/path_hypothesis.h"
#include "mapmatch/vehicle_motion.h"

namespace maploop::mapmatch {

// Holds the evidence of a fix for a hypothesis.
struct PathEvidence {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();           // m
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  // m^2, of the fix
  Motion motion;
};

class PathKalman {
 public:
  static constexpr double max_azimuth_misfit = 16.0;  // sigmas squared
  static constexpr double standing = 0.3;             // m/s, slower is no driving

  PathKalman(const RoadNetwork& network, const MatchParameters& parameters)
      : network_(&network), parameters_(&parameters) {}

  // Initializes a new hypothesis at a point of its link; h.link and h.s must be set.
  void begin(PathHypothesis& h, const LinkPoint& point, const PathEvidence& e) const;
  void predict(PathHypothesis& h, const PathEvidence& e) const;
  // Adapts the offset when the hypothesis enters another link.
  void enter_link(PathHypothesis& h, const PathEvidence& e) const;
  void correct(PathHypothesis& h, const PathEvidence& e) const;

  // Returns the azimuth of the vehicle minus that of the path, rad, in (-pi, pi].
  double azimuth_error(const PathHypothesis& h, const PathEvidence& e) const;

 private:
  struct PlaceOnPath {
    PathPoint on;
    double s = 0.0;  // m along the hypothesis's path
  };
  PlaceOnPath best_place(const PathHypothesis& h, const PathEvidence& e,
                         const Eigen::Matrix2d& R) const;
  void judge_offset(PathHypothesis& h, const PathPoint& best, const PathEvidence& e) const;
  void correct_by_azimuth(PathHypothesis& h, const PathEvidence& e) const;
  Eigen::Matrix2d slow_covariance(const PathEvidence& e) const;
  Eigen::Matrix2d fast_covariance(const PathEvidence& e) const;
  double corner_cut(const PathEvidence& e) const;
  double azimuth_at(const PathHypothesis& h, double s) const;

  const RoadNetwork* network_;
  const MatchParameters* parameters_;
};

}  // namespace maploop::mapmatch
