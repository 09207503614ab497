// Provides views of rendered boards, found in their images or computed from the truth.
#pragma once

#include <optional>
#include <random>
#include <string>
#include <vector>

#include "tests/support/board_renderer.h"
#include "tools/calibrate/calibration.h"

namespace maploop::calibrate {

// The board of nearly all tests.
inline const Board board{9, 6, 0.03};

inline testing::RenderedBoard rendered(const Board& board) {
  return {board.columns, board.rows, board.square};
}

inline sensors::CameraModel as_model(const testing::RenderedCamera& c) {
  return {c.fx, c.fy, c.cx, c.cy, {c.k1, c.k2, c.p1, c.p2, c.k3}};
}

// Returns the true corners of a view, with white noise of `sigma` px.
inline View ideal_view(const testing::BoardRenderer& renderer, const Board& board,
                       const Eigen::Isometry3d& T_left_board, double sigma, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 1.0);
  View view{"view" + std::to_string(seed), {}, {}};
  for (const Eigen::Vector2d& p : board.points())
    for (const bool left : {true, false}) {
      const Eigen::Vector3d in_left = T_left_board * Eigen::Vector3d(p.x(), p.y(), 0.0);
      const Eigen::Vector2d error(noise(random), noise(random));
      (left ? view.left : view.right).push_back(renderer.project(left, in_left) + sigma * error);
    }
  return view;
}

// Returns the view as the command finds it. Throws if a board is not found.
inline View found_view(testing::BoardRenderer& renderer, const Board& board,
                       const Eigen::Isometry3d& T_left_board, const testing::RenderQuality& quality,
                       std::uint32_t seed) {
  const StereoPair pair = renderer.render(rendered(board), T_left_board, quality, seed);
  const Corners left = find_corners(pair.left, board).value();
  const Corners right = find_corners(pair.right, board).value();
  return {"view" + std::to_string(seed), left, order_alike(right, left, board)};
}

// Returns the estimate minus the truth, in the order of Adjustment::sigma.
inline CommonVector error_of(const sensors::StereoRig& rig, const testing::RenderedRig& truth) {
  CommonVector error;
  const auto put = [&](int at, sensors::CameraModel found, sensors::CameraModel true_camera) {
    for (std::size_t i = 0; i < camera_parameter_count; ++i)
      error[at + static_cast<int>(i)] = *numbers_of(found)[i] - *numbers_of(true_camera)[i];
  };
  put(0, rig.left, as_model(truth.left));
  put(camera_parameter_count, rig.right, as_model(truth.right));
  const Eigen::AngleAxisd turn(rig.T_right_left.linear() * truth.T_right_left.linear().transpose());
  error.segment<3>(2 * camera_parameter_count) = turn.angle() * turn.axis();
  error.tail<3>() = rig.T_right_left.translation() - truth.T_right_left.translation();
  return error;
}

}  // namespace maploop::calibrate
