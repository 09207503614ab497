#include "tools/calibrate/extrinsics/lever.h"

#include <algorithm>

#include "msgs/small_turn.h"
#include "tools/calibrate/extrinsics/pose_chain.h"
#include "tools/calibrate/extrinsics/robust_fit.h"

namespace maploop::extrinsics {
namespace {

using Eigen::Isometry3d, Eigen::Matrix3d, Eigen::Vector3d;

constexpr double window = 2.0;        // s, of the motions that are compared
constexpr double window_block = 4.0;  // s, twice as long as the windows that overlap
constexpr int least_equations = 20;
constexpr double odometry_error = 0.001;  // of the way, in step with the turns
constexpr double sideslip = 0.002;        // rad, in step with the turns
constexpr double unknown_position = 3.0, unknown_scale = 0.03;  // m, 1

// The motions A and B of both sensors over one window.
struct Window {
  Isometry3d A, B;
  int block;
};

std::vector<Window> windows_of(std::span<const SensorMotion> a, std::span<const SensorMotion> b,
                               double delay) {
  std::vector<Window> windows;
  const PoseChain chain_a(a), chain_b(b);
  for (const SensorMotion& m : b) {
    const Time end = m.from + from_seconds(window);
    const auto B = chain_b.motion(m.from, end, 0.0), A = chain_a.motion(m.from, end, delay);
    if (!A || !B) continue;
    const double begin = to_seconds(m.from - b.front().from);
    windows.push_back({*A, *B, static_cast<int>(begin / window_block)});
  }
  return windows;
}

}  // namespace

HandEye hand_eye(std::span<const SensorMotion> a, std::span<const SensorMotion> b,
                 const RateAlignment& alignment) {
  HandEye result;
  result.T_a_b.linear() = alignment.R_a_b;
  result.rotation_covariance = alignment.covariance.topLeftCorner<3, 3>();
  const std::vector<Window> windows = windows_of(a, b, alignment.delay);
  if (static_cast<int>(windows.size()) < least_equations) return result;
  Eigen::VectorXd sigma(7), known = Eigen::VectorXd::Zero(7);
  sigma << Vector3d::Constant(unknown_position), unknown_scale, alignment.rotation_sigma();
  Fit fit;
  for (int i = 0; i < 4; ++i) {
    std::vector<Equation> equations;
    const Matrix3d R = result.T_a_b.linear();
    for (const auto& [A, B, block] : windows) {
      const Vector3d moved = R * B.translation();
      Eigen::Matrix<double, 3, 7> J;
      J << A.linear() - Matrix3d::Identity(), -moved, result.scale * cross_matrix(moved);
      equations.push_back({J,
                           result.scale * moved - A.translation() -
                               (A.linear() - Matrix3d::Identity()) * result.T_a_b.translation(),
                           block});
    }
    fit = robust_fit(equations, known, sigma);
    known += fit.step;
    result.T_a_b.translation() += fit.step.head<3>();
    result.scale += fit.step[3];
    result.T_a_b.linear() = rotation_of(fit.step.tail<3>()) * R;
  }
  result.found = true;
  const Eigen::VectorXd all = fit.covariance.diagonal().cwiseSqrt();
  double way = 0.0, turn = 1e-12;  // sums of squares
  for (const Window& w : windows) {
    way += w.B.translation().squaredNorm();
    turn += turn_of(w.B.linear()).squaredNorm();
  }
  const double systematic = odometry_error * std::sqrt(way / turn);
  result.position_sigma =
      (all.head<3>().array().square() + systematic * systematic).sqrt().min(unknown_position);
  result.scale_sigma = all[3];
  result.rotation_covariance = fit.covariance.bottomRightCorner<3, 3>();
  return result;
}

Travel travel_of(std::span<const SensorMotion> motions, const Matrix3d& R_body_sensor, double slip,
                 double slip_sigma) {
  Travel result;
  std::vector<Equation> sideways, upward;
  double way = 0.0, turned = 1e-12;  // sums of squares
  for (const SensorMotion& m : motions) {
    const double step = to_seconds(m.to - m.from);
    const Matrix3d half = rotation_of(-0.5 * turn_of(m.T_from_to.linear()));  // to mid time's axes
    const Vector3d v = R_body_sensor * (half * m.T_from_to.translation()) / step;
    const Vector3d rate = R_body_sensor * m.rate();
    const double slipped = v.x() * v.x() * rate.z();
    const int block = static_cast<int>(to_seconds(m.from - motions.front().from) / window_block);
    const Eigen::Matrix<double, 1, 1> left(v.y() + slip * slipped), up(v.z());
    sideways.push_back({Eigen::RowVector3d(v.x(), rate.z(), -slipped), left, block});
    upward.push_back({Eigen::RowVector2d(v.x(), -rate.y()), up, block});
    way += v.squaredNorm();
    turned += rate.z() * rate.z();
  }
  if (static_cast<int>(sideways.size()) < least_equations) return result;
  const Fit side = robust_fit(
      sideways, Vector3d::Zero(),
      Vector3d(result.course_sigma, result.axle_distance_sigma, std::max(1e-9, slip_sigma)));
  const Fit rise = robust_fit(upward, Eigen::Vector2d::Zero(),
                              Eigen::Vector2d(result.climb_sigma, result.axle_distance_sigma));
  result.found = true;
  result.course = side.step[0];
  result.course_sigma = std::sqrt(side.covariance(0, 0));
  result.axle_distance = side.step[1];
  result.axle_distance_sigma =
      std::min(result.axle_distance_sigma,
               std::hypot(std::sqrt(side.covariance(1, 1)), sideslip * std::sqrt(way / turned)));
  result.climb = rise.step[0];
  result.climb_sigma = std::sqrt(rise.covariance(0, 0));
  return result;
}

}  // namespace maploop::extrinsics
