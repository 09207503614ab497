// Calibrates a stereo camera from views of a chessboard.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "sensors/camera/stereo_rig.h"
#include "tools/calibrate/board_adjustment.h"

namespace maploop::calibrate {

constexpr std::size_t fewest_views = 6;

struct ViewResult {
  View view;
  std::array<Corners, 2> residuals;  // measured - projected, px
  Eigen::Isometry3d T_left_board;
};

struct BadView {
  std::string name;
  double rms = 0.0;    // px, when the view was left out
  double limit = 0.0;  // px, the limit that it exceeded
  int round = 0;
};

// How much of an image the corners of all views cover: the number of corners in each of 8 x 6
// fields, and the share of fields with a corner.
struct Coverage {
  static constexpr int columns = 8, rows = 6;
  std::array<int, columns * rows> corners{};

  double share() const;
  // Returns for instance "upper left" if none of that corner's 2 x 2 fields has a board corner.
  std::vector<std::string> empty_corners() const;
};

// How much the tilts of the boards differ between views: root mean square, rad, in the direction in
// which they differ most, and across it.
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
  // Left and right distortion coefficients in the direction used in photogrammetry, distorted ->
  // undistorted.
  std::array<sensors::ReversedDistortion, 2> reversed;
  // Root mean square difference of a corner's rows in the rectified left and right image, px.
  double row_error = 0.0;
  std::vector<std::string> warnings;
};

// Makes at most five adjustments. Before the first and after each but the last, views are left out,
// the worst first, whose root mean square distance exceeds both 2.5 times the median of all views
// and 0.2 px (before the first: 5 px); at least fewest_views remain. Throws std::runtime_error that
// names the problem: too few views, boards all parallel, parameters that the views do not
// determine, left and right swapped.
StereoResult calibrate(const Board& board, std::vector<View> views, int width, int height);

}  // namespace maploop::calibrate
