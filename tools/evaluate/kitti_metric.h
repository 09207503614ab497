// Measures the errors of an estimated trajectory like the KITTI odometry benchmark.
//
// A segment starts at a frame and ends at the first frame whose distance along the truth is greater
// than `length`. Its error is E = (T_est_first^-1 T_est_last)^-1 (T_truth_first^-1 T_truth_last);
// |t(E)| and the angle of R(E) are divided by `length` (Geiger, Lenz, Urtasun, CVPR 2012, and the
// benchmark's devkit). Frame i of one trajectory is frame i of the other; the longer one is cut.
// Both are taken relative to their own first pose.
#pragma once

#include <Eigen/Core>

#include "tools/evaluate/trajectory_file.h"

namespace maploop::evaluation {

// What to do with a constant rotation between the two body frames (an error of extrinsics or of the
// truth's own azimuth, not of the odometry).
enum class CommonRotation { keep, remove };

struct SegmentError {
  double percent = 0.0;    // mean translation error, % of the length; NaN without a segment
  double deg_per_m = 0.0;  // mean rotation error; NaN without a segment
  int segments = 0;
};

struct Score {
  double distance_m = 0.0;         // length of the truth over the frames compared
  double end_point_m = 0.0;        // |t| between the two last poses
  double end_point_percent = 0.0;  // of the distance; NaN if the truth does not move
  SegmentError segment;            // segments start at every frame
  int frames = 0;                  // number of frames compared, that of the shorter trajectory
};

// Returns the way along the trajectory to each pose, m.
std::vector<double> distances(const Trajectory& trajectory);

// Scores segments of one length (m), starting at every frame. Throws std::invalid_argument if a
// trajectory has fewer than two poses or the length is not positive.
Score score(const Trajectory& estimate, const Trajectory& truth, double length_m,
            CommonRotation common_rotation = CommonRotation::keep);

// Returns the benchmark's own figure: lengths 100, 200, ..., 800 m, from every tenth frame, the
// plain mean over all segments. Throws like score().
SegmentError kitti_odometry_error(const Trajectory& estimate, const Trajectory& truth);

// Returns the rotation R that best maps the estimate's 25 m segments onto the truth's, R t_est ~
// t_truth, in the least-squares sense (Kabsch 1976, by SVD); the identity if the drive is shorter.
// If all segments are alike (a straight drive, a constant bend), the rotation about them is not
// determined.
Eigen::Matrix3d fit_common_rotation(const Trajectory& estimate, const Trajectory& truth);

}  // namespace maploop::evaluation
