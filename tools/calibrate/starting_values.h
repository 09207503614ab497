// Computes the starting values of the adjustment.
#pragma once

#include <vector>

#include "tools/calibrate/board_adjustment.h"

namespace maploop::calibrate {

struct StartingValues {
  Cameras cameras;
  std::vector<Eigen::Isometry3d> T_left_board;
};

// Calibrates each camera independently (Zhang 2000, by OpenCV), and takes the median over the views
// for the pose between the cameras. Throws std::runtime_error if no camera fits.
StartingValues starting_values(const Board& board, const std::vector<View>& views, int width,
                               int height);

}  // namespace maploop::calibrate
