#include "tests/support/board_renderer.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <stdexcept>

namespace maploop::testing {
namespace {

constexpr int rays_each_way = 4;  // per pixel, each way

cv::Mat camera_matrix(const RenderedCamera& c) {
  return (cv::Mat_<double>(3, 3) << c.fx, 0.0, c.cx, 0.0, c.fy, c.cy, 0.0, 0.0, 1.0);
}

cv::Mat coefficients(const RenderedCamera& c) {
  return (cv::Mat_<double>(5, 1) << c.k1, c.k2, c.p1, c.p2, c.k3);
}

// Returns the brightness of a point of the board's plane, in squares from the first inner corner.
float brightness(const RenderedBoard& board, double x, double y) {
  constexpr float black = 30.0F, white = 215.0F, behind = 110.0F;
  const double margin = 1.7;  // squares beyond the first and last inner corner
  if (x < -margin || y < -margin || x > board.columns - 1 + margin || y > board.rows - 1 + margin)
    return behind;
  const auto column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
  if (column < -1 || row < -1 || column >= board.columns || row >= board.rows) return white;
  return (column + row) % 2 == 0 ? black : white;
}

}  // namespace

RenderedRig example_rig() {
  RenderedRig rig;
  rig.width = 752;
  rig.height = 480;
  rig.left = {458.6, 457.3, 367.2, 248.4, -0.2834, 0.0739, 0.00019, 0.000018, -0.008};
  rig.right = {457.5, 456.1, 379.9, 255.2, -0.2837, 0.0745, -0.00010, -0.000035, -0.009};
  rig.T_right_left.linear() =
      Eigen::AngleAxisd(0.014, Eigen::Vector3d(0.6, -0.7, 0.4).normalized()).matrix();
  rig.T_right_left.translation() << -0.1200, 0.0007, -0.0011;
  return rig;
}

BoardRenderer::BoardRenderer(const RenderedRig& rig) : rig_(rig) {}

std::vector<float> BoardRenderer::rays_of(const RenderedCamera& camera) const {
  std::vector<cv::Point2d> pixels, undistorted;
  for (int v = 0; v < rig_.height * rays_each_way; ++v)
    for (int u = 0; u < rig_.width * rays_each_way; ++u)
      pixels.emplace_back((u + 0.5) / rays_each_way - 0.5, (v + 0.5) / rays_each_way - 0.5);
  cv::undistortPoints(pixels, undistorted, camera_matrix(camera), coefficients(camera),
                      cv::noArray(), cv::noArray(),
                      {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 1e-10});
  std::vector<float> rays;
  rays.reserve(2 * undistorted.size());
  for (const cv::Point2d& p : undistorted) {
    rays.push_back(static_cast<float>(p.x));
    rays.push_back(static_cast<float>(p.y));
  }
  return rays;
}

GreyImage BoardRenderer::render(const std::vector<float>& rays, const RenderedBoard& board,
                                const Eigen::Isometry3d& T_camera_board,
                                const RenderQuality& quality, std::uint32_t seed) const {
  // (x, y, 1) s = T (X, Y, 0) is the plane's homography, which is inverted here.
  Eigen::Matrix3d plane;
  plane << T_camera_board.linear().col(0) * board.square,
      T_camera_board.linear().col(1) * board.square, T_camera_board.translation();
  const Eigen::Matrix3d to_board = plane.inverse();
  cv::Mat mean(rig_.height, rig_.width, CV_32FC1);
  for (int v = 0; v < rig_.height; ++v)
    for (int u = 0; u < rig_.width; ++u) {
      float sum = 0.0F;
      for (int i = 0; i < rays_each_way; ++i)
        for (int k = 0; k < rays_each_way; ++k) {
          const auto at = 2 * (static_cast<std::size_t>(v * rays_each_way + i) *
                                   static_cast<std::size_t>(rig_.width * rays_each_way) +
                               static_cast<std::size_t>(u * rays_each_way + k));
          const Eigen::Vector3d on_board = to_board * Eigen::Vector3d(rays[at], rays[at + 1], 1.0);
          sum += brightness(board, on_board.x() / on_board.z(), on_board.y() / on_board.z());
        }
      mean.at<float>(v, u) = sum / (rays_each_way * rays_each_way);
    }
  if (quality.blur > 0.0) cv::GaussianBlur(mean, mean, {0, 0}, quality.blur);
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(0.0F, static_cast<float>(quality.noise));
  GreyImage image;
  image.resize(rig_.width, rig_.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    float value = mean.ptr<float>()[i];
    if (quality.noise > 0.0) value += noise(random);
    image.pixels[i] = static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
  }
  return image;
}

StereoPair BoardRenderer::render(const RenderedBoard& board, const Eigen::Isometry3d& T_left_board,
                                 const RenderQuality& quality, std::uint32_t seed) {
  if (left_.empty()) {
    left_ = rays_of(rig_.left);
    right_ = rays_of(rig_.right);
  }
  StereoPair pair;
  pair.left = render(left_, board, T_left_board, quality, 2 * seed);
  pair.right = render(right_, board, rig_.T_right_left * T_left_board, quality, 2 * seed + 1);
  return pair;
}

Eigen::Vector2d BoardRenderer::project(bool left, const Eigen::Vector3d& in_left) const {
  const RenderedCamera& camera = left ? rig_.left : rig_.right;
  const Eigen::Vector3d p = left ? in_left : Eigen::Vector3d(rig_.T_right_left * in_left);
  std::vector<cv::Point2d> pixel;
  cv::projectPoints(std::vector<cv::Point3d>{{p.x(), p.y(), p.z()}}, cv::Vec3d(), cv::Vec3d(),
                    camera_matrix(camera), coefficients(camera), pixel);
  return {pixel[0].x, pixel[0].y};
}

std::vector<Eigen::Isometry3d> board_poses(const BoardRenderer& renderer, const RenderedRig& rig,
                                           const RenderedBoard& board, std::size_t count,
                                           double distance, double tilt, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  const Eigen::Vector3d middle(0.5 * (board.columns - 1) * board.square,
                               0.5 * (board.rows - 1) * board.square, 0.0);
  // A view is refused if a side of a square is shorter than this.
  const auto is_large = [&](const Eigen::Isometry3d& T_left_board) {
    constexpr double shortest = 11.0;  // px
    for (const bool left : {true, false})
      for (const int column : {0, board.columns - 2})
        for (const int row : {0, board.rows - 2}) {
          const auto corner = [&](int dx, int dy) {
            const Eigen::Vector3d p(column + dx, row + dy, 0.0);
            return renderer.project(left, T_left_board * (board.square * p));
          };
          if ((corner(1, 0) - corner(0, 0)).norm() < shortest ||
              (corner(0, 1) - corner(0, 0)).norm() < shortest)
            return false;
        }
    return true;
  };
  const auto is_seen = [&](const Eigen::Isometry3d& T_left_board) {
    constexpr double border = 5.0;  // px
    for (const double x : {-1.5, board.columns + 0.5})
      for (const double y : {-1.5, board.rows + 0.5})
        for (const bool left : {true, false}) {
          const Eigen::Vector3d corner(x * board.square, y * board.square, 0.0);
          const Eigen::Vector2d p = renderer.project(left, T_left_board * corner);
          if (!(p.x() > border && p.y() > border && p.x() < rig.width - border &&
                p.y() < rig.height - border))
            return false;
        }
    return true;
  };
  std::vector<Eigen::Isometry3d> poses;
  for (int tries = 0; poses.size() < count; ++tries) {
    if (tries > 100000) throw std::runtime_error("the board does not fit into the images");
    const double depth = distance * between(1.0, 1.8);
    const double u = between(0.0, rig.width), v = between(0.0, rig.height);
    const Eigen::Vector3d at((u - rig.left.cx) / rig.left.fx * depth,
                             (v - rig.left.cy) / rig.left.fy * depth, depth);
    const double direction = between(0.0, 6.283185307179586);
    const Eigen::Vector3d axis(std::cos(direction), std::sin(direction), 0.0);
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = (Eigen::AngleAxisd(between(0.3, 1.0) * tilt, axis) *
                     Eigen::AngleAxisd(between(-0.3, 0.3), Eigen::Vector3d::UnitZ()))
                        .matrix();
    pose.translation() = at - pose.linear() * middle;
    if (is_seen(pose) && is_large(pose)) poses.push_back(pose);
  }
  return poses;
}

}  // namespace maploop::testing
