// Stereo calibration from views of a chessboard.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "sensors/camera/stereo_rig.h"
#include "tools/calibrate/board_adjustment.h"

namespace maploop::calibrate {

constexpr std::size_t kMinViews = 6;

struct ViewResult {
  View view;
  std::array<Corners, 2> residuals;  // measured - projected, px
  Eigen::Isometry3d T_left_board;
};

struct BadView {
  std::string name;
  double rms = 0.0;    // px, when it was left out
  double limit = 0.0;  // px, what it was beyond
  int round = 0;
};

// How much of an image the corners of all views cover: of 8 x 6 fields those that hold one.
struct Coverage {
  static constexpr int columns = 8, rows = 6;
  std::array<int, columns * rows> corners{};

  double share() const;
  // "upper left", where none of that corner's 2 x 2 fields holds one.
  std::vector<std::string> empty_corners() const;
};

// How differently the views' boards are tilted: root mean square, rad, in the direction in which
// they are spread most, and across.
struct TiltSpread {
  double most = 0.0, across = 0.0;
};

struct StereoResult {
  Board board;
  sensors::StereoRig rig;
  Adjustment adjustment;
  std::vector<ViewResult> views;
  std::vector<BadView> bad;  // left out
  std::array<Coverage, 2> coverage;
  TiltSpread tilt;
  // Coefficients in photogrammetry's direction, distorted -> undistorted; left and right.
  std::array<sensors::ReversedDistortion, 2> reversed;
  // Rows of a corner in the rectified left and right image apart, px, root mean square.
  double row_error = 0.0;
  std::vector<std::string> warnings;
};

// At most five adjustments: after each but the last, views whose root mean square distance is
// beyond 2.5 times the median of all views' and 0.2 px (before the first, 5 px) are left out, the
// worst first, while kMinViews stay. Throws std::runtime_error that names what is wrong: too few
// views, boards all parallel, parameters that the views do not determine, left and right swapped.
StereoResult calibrate(const Board& board, std::vector<View> views, int width, int height);

}  // namespace maploop::calibrate
