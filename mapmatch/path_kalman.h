// The Kalman filter of one path hypothesis: its place along the path, and the fixes' offset from
// it.
//
// State: s (m along the link, as driven) and the offset (m, east and north) of the fixes from the
// road, which the map's error and the slow part of the fixes' errors make up: a Gauss-Markov
// process of parameters.correlation_time. Predicted by the distance travelled; corrected by the
// fixes, and by their azimuths where the path bends. What does not fit lowers the hypothesis's log
// weight. METHOD.md has the equations. No allocation.
#pragma once

#include <Eigen/Core>

#include "mapmatch/match_parameters.h"
#include "mapmatch/path_hypothesis.h"
#include "mapmatch/vehicle_motion.h"

namespace maploop::mapmatch {

// What a fix tells a hypothesis.
struct PathEvidence {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();           // m
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  // of the fix
  Motion motion;
};

class PathKalman {
 public:
  static constexpr double max_azimuth_misfit = 16.0;  // sigmas squared

  PathKalman(const RoadNetwork& network, const MatchParameters& parameters)
      : network_(&network), parameters_(&parameters) {}

  // A hypothesis that is born at a point of its link; h.link and h.s are set.
  void begin(PathHypothesis& h, const LinkPoint& point, const PathEvidence& e) const;
  void predict(PathHypothesis& h, const PathEvidence& e) const;
  // It is on another link now.
  void enter_link(PathHypothesis& h, const PathEvidence& e) const;
  void correct(PathHypothesis& h, const PathEvidence& e) const;

  // Of the vehicle less that of the path, rad, in (-pi, pi].
  double azimuth_error(const PathHypothesis& h, const PathEvidence& e) const;

 private:
  struct PlaceOnPath {
    PathPoint on;
    double s = 0.0;  // along the hypothesis's path
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
