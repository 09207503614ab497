// Where the adjustment starts.
#pragma once

#include <vector>

#include "tools/calibrate/board_adjustment.h"

namespace maploop::calibrate {

struct StartingValues {
  Cameras cameras;
  std::vector<Eigen::Isometry3d> T_left_board;
};

// Each camera for itself (Zhang 2000, by OpenCV), and the median over the views of what one sees
// against the other. Throws std::runtime_error where that finds no camera.
StartingValues starting_values(const Board& board, const std::vector<View>& views, int width,
                               int height);

}  // namespace maploop::calibrate
