// Renders images of a chessboard as two real cameras would take them, with known truth.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "msgs/image.h"

namespace maploop::testing {

// This is OpenCV's camera model, undistorted -> distorted.
struct RenderedCamera {
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;
  double k1 = 0.0, k2 = 0.0, p1 = 0.0, p2 = 0.0, k3 = 0.0;
};

struct RenderedRig {
  int width = 0, height = 0;
  RenderedCamera left, right;
  Eigen::Isometry3d T_right_left = Eigen::Isometry3d::Identity();
};

struct RenderedBoard {
  int columns = 9, rows = 6;  // inner corners; one more square and a white margin are drawn
  double square = 0.03;       // m
};

struct RenderQuality {
  double blur = 0.7;   // px, sigma of the lens and the pixel's neighbours
  double noise = 2.0;  // grey levels, sigma
};

// Returns cameras like a car's: 12 cm apart, with lenses that bend a corner by tens of pixels.
RenderedRig example_rig();

// A BoardRenderer renders one rig's views. Each pixel is the mean of 4 x 4 rays. It is
// deterministic.
class BoardRenderer {
 public:
  explicit BoardRenderer(const RenderedRig& rig);

  // The board's first corner is the origin of its frame, and its corners lie along x and y.
  StereoPair render(const RenderedBoard& board, const Eigen::Isometry3d& T_left_board,
                    const RenderQuality& quality, std::uint32_t seed);

  // Returns where a point in the left camera's frame (m) is seen, px.
  Eigen::Vector2d project(bool left, const Eigen::Vector3d& in_left) const;

 private:
  // Returns undistorted x, y at unit depth for every ray.
  std::vector<float> rays_of(const RenderedCamera& camera) const;
  GreyImage render(const std::vector<float>& rays, const RenderedBoard& board,
                   const Eigen::Isometry3d& T_camera_board, const RenderQuality& quality,
                   std::uint32_t seed) const;

  RenderedRig rig_;
  std::vector<float> left_, right_;  // computed on the first use, which takes a second
};

// Returns poses that show the whole board to both cameras: all over the image, at `distance` m to
// 1.8 times that, tilted by up to `tilt` rad in all directions. It is deterministic.
std::vector<Eigen::Isometry3d> board_poses(const BoardRenderer& renderer, const RenderedRig& rig,
                                           const RenderedBoard& board, std::size_t count,
                                           double distance, double tilt, std::uint32_t seed);

}  // namespace maploop::testing
