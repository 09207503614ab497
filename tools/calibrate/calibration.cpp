#include "tools/calibrate/calibration.h"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "sensors/camera/rectification.h"
#include "tools/command/median.h"

namespace maploop::calibrate {
namespace {

constexpr double radians_per_degree = std::numbers::pi / 180.0;

std::string shown(double value, int digits = 2) {
  return fmt::format("{:.{}f}", value, digits);
}

TiltSpread tilt_spread(const std::vector<Eigen::Isometry3d>& T_left_board) {
  const auto count = static_cast<double>(T_left_board.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& pose : T_left_board) mean += pose.linear().col(2) / count;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const auto& pose : T_left_board) {
    const Eigen::Vector3d off = pose.linear().col(2) - mean;
    spread += off * off.transpose() / count;
  }
  const Eigen::Vector3d variances =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvalues().cwiseMax(0.0);
  return {std::sqrt(variances[2]), std::sqrt(variances[1])};
}

// If all boards are parallel, a nearer board with a shorter focal length looks the same as a
// farther board with a longer one.
void require_different_tilts(const StereoResult& r) {
  constexpr double least_tilt = 4.0 * radians_per_degree, most_sigma = 0.02;
  const double f_sigma = r.adjustment.sigma[0] / r.adjustment.cameras.left.fx;
  if (r.tilt.most > least_tilt && f_sigma < most_sigma) return;
  throw std::runtime_error(
      "the boards of all " + std::to_string(r.adjustment.T_left_board.size()) +
      " views are too nearly parallel (their tilts scatter by " +
      shown(r.tilt.most / radians_per_degree, 1) +
      " deg): focal length and distance cannot be told apart; tilt the board by 20 to 40 deg, to "
      "the left, right, front and back");
}

// Removes the views beyond the limit of this round from `views` and returns them, the worst first.
std::vector<BadView> take_out_bad(const Residuals& residuals, int round, double floor,
                                  std::vector<View>& views) {
  constexpr double factor = 2.5;
  std::vector<double> rms;
  for (const auto& of_view : residuals) rms.push_back(rms_of_view(of_view));
  const double limit = std::max(factor * tools::median(rms), floor);
  std::vector<BadView> bad;
  while (views.size() > fewest_views) {
    const auto worst = std::max_element(rms.begin(), rms.end()) - rms.begin();
    const auto at = static_cast<std::size_t>(worst);
    if (!(rms[at] > limit)) break;
    bad.push_back({views[at].name, rms[at], limit, round});
    views.erase(views.begin() + worst);
    rms.erase(rms.begin() + worst);
  }
  return bad;
}

Coverage coverage_of(const std::vector<View>& views, Corners View::*side, int width, int height) {
  Coverage coverage;
  const auto field = [](double at, int size, int fields) {
    return std::clamp(static_cast<int>(at / size * fields), 0, fields - 1);
  };
  for (const View& view : views)
    for (const Eigen::Vector2d& c : view.*side) {
      const int row = field(c.y(), height, Coverage::rows);
      const int column = field(c.x(), width, Coverage::columns);
      ++coverage.corners[static_cast<std::size_t>(row * Coverage::columns + column)];
    }
  return coverage;
}

// Returns the root mean square difference between a corner's rows in the rectified left and right
// image.
double row_error(const sensors::StereoRig& rig, const std::vector<View>& views) {
  double squares = 0.0;
  std::size_t count = 0;
  const auto row = [&](const sensors::CameraModel& camera, const Eigen::Matrix3d& R_rect,
                       const Eigen::Vector2d& pixel) {
    const auto ray = sensors::ray_of(camera, pixel);
    if (!ray) return std::numeric_limits<double>::quiet_NaN();
    const Eigen::Vector3d turned = R_rect * ray->homogeneous();
    return rig.rectified.fy * turned.y() / turned.z();
  };
  for (const View& view : views)
    for (std::size_t i = 0; i < view.left.size(); ++i) {
      const double apart = row(rig.left, rig.R_rect_left, view.left[i]) -
                           row(rig.right, rig.R_rect_right, view.right[i]);
      squares += apart * apart;
      ++count;
    }
  return std::sqrt(squares / static_cast<double>(count));
}

std::vector<std::string> warnings_of(const StereoResult& r) {
  std::vector<std::string> warnings;
  constexpr std::size_t good_views = 15;
  if (r.views.size() < good_views)
    warnings.push_back("only " + std::to_string(r.views.size()) +
                       " views: " + std::to_string(good_views) + " to 40 make the result safer");
  if (r.adjustment.rms > 1.0)
    warnings.push_back("the corners lie " + shown(r.adjustment.rms) +
                       " px from where the cameras should see them: is the board flat and its "
                       "square size true, and did both cameras expose at one moment?");
  const double f_sigma = std::max(r.adjustment.sigma[0] / r.rig.left.fx,
                                  r.adjustment.sigma[camera_parameter_count] / r.rig.right.fx);
  if (f_sigma > 0.003)
    warnings.push_back("the focal length is known to " + shown(100.0 * f_sigma) +
                       " % only: tilt the board more");
  if (r.tilt.across < 4.0 * radians_per_degree)
    warnings.push_back("the board is tilted about one axis only (about the other by " +
                       shown(r.tilt.across / radians_per_degree, 1) +
                       " deg): tilt it to the sides as well as to the front and back");
  for (std::size_t side = 0; side < 2; ++side) {
    const std::string name = side == 0 ? "left" : "right";
    std::string empty;
    for (const std::string& corner : r.coverage[side].empty_corners())
      empty += (empty.empty() ? "" : ", ") + corner;
    if (!empty.empty())
      warnings.push_back("no corner of the board in the " + empty + " of the " + name +
                         " image: the distortion is a guess there");
    if (r.reversed[side].largest_error > 0.1)
      warnings.push_back("of the " + name +
                         " camera, the coefficients distorted -> undistorted differ from the "
                         "others by up to " +
                         shown(r.reversed[side].largest_error) + " px");
  }
  return warnings;
}

}  // namespace

double Coverage::share() const {
  const auto filled = std::count_if(corners.begin(), corners.end(), [](int n) { return n > 0; });
  return static_cast<double>(filled) / static_cast<double>(corners.size());
}

std::vector<std::string> Coverage::empty_corners() const {
  std::vector<std::string> empty;
  for (const int bottom : {0, 1})
    for (const int right : {0, 1}) {
      int count = 0;
      for (const int row : {0, 1})
        for (const int column : {0, 1}) {
          const int r = bottom != 0 ? rows - 1 - row : row;
          const int c = right != 0 ? columns - 1 - column : column;
          count += corners[static_cast<std::size_t>(r * columns + c)];
        }
      if (count == 0)
        empty.push_back(std::string(bottom != 0 ? "lower " : "upper ") +
                        (right != 0 ? "right" : "left"));
    }
  return empty;
}

StereoResult calibrate(const Board& board, std::vector<View> views, int width, int height) {
  if (views.size() < fewest_views) {
    throw std::runtime_error("too few views: the board is found in both images of " +
                             std::to_string(views.size()) + " pairs, and " +
                             std::to_string(fewest_views) + " are needed (20 to 40 are good)");
  }
  StereoResult result;
  result.board = board;

  // Round 0 removes views before the first adjustment, because a pair whose images were taken at
  // different times would distort it.
  constexpr int max_rounds = 5;
  constexpr double coarse = 5.0, fine = 0.2;  // px, floor of the limit
  for (int round = 0; round <= max_rounds; ++round) {
    const StartingValues start = starting_values(board, views, width, height);
    Residuals residuals;
    if (round == 0) {
      residuals = residuals_at(board, views, start.cameras, start.T_left_board);
    } else {
      result.adjustment = adjust(board, views, start.cameras, start.T_left_board);
      residuals = result.adjustment.residuals;
    }
    if (round == max_rounds) break;
    const auto bad = take_out_bad(residuals, round, round == 0 ? coarse : fine, views);
    if (bad.empty() && round > 0) break;
    result.bad.insert(result.bad.end(), bad.begin(), bad.end());
  }
  result.tilt = tilt_spread(result.adjustment.T_left_board);
  require_different_tilts(result);
  const Cameras& cameras = result.adjustment.cameras;
  result.rig = sensors::rectify(cameras.left, cameras.right, cameras.T_right_left, width, height);
  for (std::size_t v = 0; v < views.size(); ++v)
    result.views.push_back(
        {views[v], result.adjustment.residuals[v], result.adjustment.T_left_board[v]});
  result.coverage = {coverage_of(views, &View::left, width, height),
                     coverage_of(views, &View::right, width, height)};
  result.reversed = {sensors::reversed(result.rig.left, width, height),
                     sensors::reversed(result.rig.right, width, height)};
  result.row_error = row_error(result.rig, views);
  result.warnings = warnings_of(result);
  return result;
}

}  // namespace maploop::calibrate
