// This file interpolates the reference pose at any moment of a drive, to score at the stamps of
// other sensors.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <vector>

#include "msgs/local_frame.h"
#include "msgs/reference.h"
#include "sensors/source.h"

namespace maploop::sensors {

// Every row of a recording's reference; nothing where it has none.
std::vector<ReferencePose> read_rows(const std::unique_ptr<Source<ReferencePose>>& reference);

struct ReferenceTrajectoryParameters {
  // s beyond the first and last row: images start a few milliseconds outside of the rows.
  double max_extrapolation = 0.020;
  // s between two rows: across a longer gap a straight line is not the true path (at 3 m/s^2 it is
  // off by 5 cm in the middle of such a gap).
  double max_gap = 0.350;
};

class ReferenceTrajectory {
 public:
  // Takes at least two rows with strictly increasing stamps; throws std::invalid_argument
  // otherwise.
  ReferenceTrajectory(const std::vector<ReferencePose>& rows, const LocalFrame& frame,
                      const ReferenceTrajectoryParameters& parameters = {});

  // The same of poses in a frame of their own, whose accuracy is not known (0).
  ReferenceTrajectory(const std::vector<Time>& stamps, const std::vector<Eigen::Isometry3d>& poses,
                      const ReferenceTrajectoryParameters& parameters = {});

  // Returns T_enu_body in the local frame, or the poses' own. Between two rows the position lies on
  // a straight line and the attitude turns at a constant rate (slerp); at the ends the same motion
  // is extrapolated. Returns nothing outside of that or inside a gap.
  std::optional<Eigen::Isometry3d> pose(Time stamp) const;

  // m, the recorder's own estimate of the position's accuracy: the worse of the two neighbouring
  // rows.
  double accuracy(Time stamp) const;

 private:
  struct Row {
    Time stamp;
    Eigen::Vector3d p_enu;
    Eigen::Quaterniond q_enu_body;
    double accuracy;  // m
  };
  void add(const Row& row);
  void check_size() const;
  // Returns the second of the two rows around the stamp; at the ends the two outermost rows are
  // used.
  const Row& row_after(Time stamp) const;
  std::vector<Row> rows_;
  Duration max_extrapolation_;
  Duration max_gap_;
};

}  // namespace maploop::sensors
