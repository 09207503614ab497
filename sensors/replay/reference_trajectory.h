// The reference pose at any moment of a drive, for scoring at the stamps of other sensors.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "msgs/local_frame.h"
#include "msgs/reference.h"

namespace maploop::sensors {

struct ReferenceTrajectoryParameters {
  // s, beyond the first and last row: images start a few milliseconds outside of the rows.
  double max_extrapolation = 0.020;
  // s between two rows: across a longer drop-out the straight line invents the truth (at 3 m/s^2
  // it is 5 cm off in the middle of this).
  double max_gap = 0.350;
};

class ReferenceTrajectory {
 public:
  // Rows with strictly increasing stamps, at least two; throws std::invalid_argument otherwise.
  ReferenceTrajectory(const std::vector<ReferencePose>& rows, const LocalFrame& frame,
                      const ReferenceTrajectoryParameters& parameters = {});

  // T_enu_body in the local frame: between two rows the position on a straight line, the attitude
  // by one rotation at a constant rate (slerp); at the ends the same motion carried on. Nothing
  // outside of that or inside a gap.
  std::optional<Eigen::Isometry3d> pose(Time stamp) const;

  // m, the recorder's own statement of the position's accuracy: the worse of the rows around.
  double accuracy(Time stamp) const;

 private:
  struct Row {
    Time stamp;
    Eigen::Vector3d p_enu;
    Eigen::Quaterniond q_enu_body;
    double accuracy;  // m
  };
  // The second of the two rows around the stamp; at the ends of the outermost two.
  const Row& row_after(Time stamp) const;
  std::vector<Row> rows_;
  Duration max_extrapolation_;
  Duration max_gap_;
};

}  // namespace maploop::sensors
