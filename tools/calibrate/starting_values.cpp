// Computes the starting values of the adjustment.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <stdexcept>
#include <string>

#include "msgs/small_turn.h"
#include "tools/calibrate/board_adjustment.h"
#include "tools/command/median.h"

namespace maploop::calibrate {
namespace {

std::vector<cv::Point2f> as_points(const Corners& corners) {
  std::vector<cv::Point2f> points;
  for (const Eigen::Vector2d& c : corners)
    points.emplace_back(static_cast<float>(c.x()), static_cast<float>(c.y()));
  return points;
}

Eigen::Isometry3d as_pose(const cv::Mat& turn, const cv::Mat& t) {
  const Eigen::Vector3d axis(turn.at<double>(0), turn.at<double>(1), turn.at<double>(2));
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = rotation_of(axis);
  pose.translation() << t.at<double>(0), t.at<double>(1), t.at<double>(2);
  return pose;
}

struct OneCamera {
  sensors::CameraModel camera;
  std::vector<Eigen::Isometry3d> T_camera_board;
};

OneCamera calibrate_one(const Board& board, const std::vector<View>& views, Corners View::*side,
                        int width, int height) {
  std::vector<std::vector<cv::Point3f>> on_board(views.size());
  std::vector<std::vector<cv::Point2f>> in_image;
  for (auto& points : on_board) {
    for (const Eigen::Vector2d& p : board.points())
      points.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()), 0.0F);
  }
  in_image.reserve(views.size());
  for (const View& view : views) in_image.push_back(as_points(view.*side));
  // OpenCV's own guess of the focal length assumes no distortion, and for strongly distorting
  // lenses it leads to false minima. Therefore focal length and k1 alone are fitted from several
  // guesses; the other parameters are fitted from the best of these. The third radial coefficient
  // is left to the adjustment.
  constexpr int few = cv::CALIB_USE_INTRINSIC_GUESS | cv::CALIB_FIX_PRINCIPAL_POINT |
                      cv::CALIB_FIX_ASPECT_RATIO | cv::CALIB_ZERO_TANGENT_DIST | cv::CALIB_FIX_K2 |
                      cv::CALIB_FIX_K3;
  cv::Mat k, d;
  std::vector<cv::Mat> turns, shifts;
  try {
    double best = std::numeric_limits<double>::infinity();
    for (const double guess : {0.4, 0.7, 1.2, 2.0}) {
      const double f = guess * width;
      cv::Mat k_try = (cv::Mat_<double>(3, 3) << f, 0.0, 0.5 * (width - 1), 0.0, f,
                       0.5 * (height - 1), 0.0, 0.0, 1.0);
      cv::Mat d_try = cv::Mat::zeros(5, 1, CV_64F);
      const double rms = cv::calibrateCamera(on_board, in_image, {width, height}, k_try, d_try,
                                             turns, shifts, few);
      if (!(rms < best)) continue;
      best = rms;
      k = k_try;
      d = d_try;
    }
    cv::calibrateCamera(on_board, in_image, {width, height}, k, d, turns, shifts,
                        cv::CALIB_USE_INTRINSIC_GUESS | cv::CALIB_FIX_K3);
  } catch (const cv::Exception& error) {
    throw std::runtime_error("no camera fits the corners found (" + std::string(error.err) +
                             "): is the board tilted differently from view to view?");
  }
  OneCamera result;
  result.camera = {k.at<double>(0, 0),
                   k.at<double>(1, 1),
                   k.at<double>(0, 2),
                   k.at<double>(1, 2),
                   {d.at<double>(0), d.at<double>(1), d.at<double>(2), d.at<double>(3), 0.0}};
  for (std::size_t v = 0; v < views.size(); ++v)
    result.T_camera_board.push_back(as_pose(turns[v], shifts[v]));
  return result;
}

Eigen::Isometry3d median_pose(const std::vector<Eigen::Isometry3d>& poses) {
  Eigen::Vector3d turn, shift;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> turns, shifts;
    for (const Eigen::Isometry3d& pose : poses) {
      const Eigen::AngleAxisd rotation(pose.linear());
      turns.push_back(rotation.angle() * rotation.axis()[axis]);
      shifts.push_back(pose.translation()[axis]);
    }
    turn[axis] = tools::median(std::move(turns));
    shift[axis] = tools::median(std::move(shifts));
  }
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = rotation_of(turn);
  result.translation() = shift;
  return result;
}

}  // namespace

StartingValues starting_values(const Board& board, const std::vector<View>& views, int width,
                               int height) {
  const OneCamera left = calibrate_one(board, views, &View::left, width, height);
  const OneCamera right = calibrate_one(board, views, &View::right, width, height);
  std::vector<Eigen::Isometry3d> T_right_left;
  for (std::size_t v = 0; v < views.size(); ++v)
    T_right_left.push_back(right.T_camera_board[v] * left.T_camera_board[v].inverse());
  return {{left.camera, right.camera, median_pose(T_right_left)}, left.T_camera_board};
}

}  // namespace maploop::calibrate
