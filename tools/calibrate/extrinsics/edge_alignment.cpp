#include "tools/calibrate/extrinsics/edge_alignment.h"

#include <array>
#include <cmath>

#include "msgs/small_turn.h"

namespace maploop::extrinsics {
namespace {

using Eigen::Isometry3d, Eigen::Vector3d;

constexpr std::size_t fewest_edges = 2000;
constexpr int stretches = 8;
constexpr double turning_distance = 12.0;  // m
constexpr double first_step = 0.1;         // m, also at the turning distance
constexpr double last_step = 0.002;        // m
constexpr double furthest_step = 3.0;      // m
constexpr double edge_turn_error = 0.001, edge_place_error = 0.02;  // rad, m

// Turns about a point that far ahead, so that the place to the right, which turns hide, is kept
// apart; then to the right, and ahead.
Isometry3d moved(const Isometry3d& T_cam_lidar, const Vector3d& step) {
  const double angle = step.x() / turning_distance;
  Isometry3d T(rotation_of(Vector3d(0.0, angle, 0.0)));
  T.translation() = Vector3d(step.y() - turning_distance * std::sin(angle), 0.0, step.z());
  return T * T_cam_lidar;
}

// Returns the mean strength of the image's edges at the scan's.
double strength(std::span<const ViewPair> views, const StereoCalibration& camera,
                const Isometry3d& T_cam_lidar) {
  double sum = 0.0, count = 1.0;
  for (const ViewPair& view : views) {
    const Isometry3d T = T_cam_lidar * view.T_scan_image.inverse();
    const GreyImage& image = view.image->edges;
    for (const Eigen::Vector3f& edge : view.scan->edges) {
      const Vector3d p = T * edge.cast<double>();
      if (p.z() < 1.0) continue;
      const double u = camera.cx + camera.fx * p.x() / p.z();
      const double v = camera.cy + camera.fy * p.y() / p.z() + 0.5;
      if (!(u >= 0.0 && u < image.width - 1 && v >= 0.0 && v < image.height)) continue;
      const auto column = static_cast<std::size_t>(u);
      const std::uint8_t* at = image.pixels.data() +
                               static_cast<std::size_t>(v) * static_cast<std::size_t>(image.width) +
                               column;
      const double part = u - static_cast<double>(column);
      sum += (1.0 - part) * at[0] + part * at[1];
      count += 1.0;
    }
  }
  return sum / count;
}

// Returns the steps after which the strength is largest. Each is tried in turn, then what they came
// to together once more (Hooke and Jeeves, "Direct search", Journal of the ACM 8, 1961).
Vector3d climb(std::span<const ViewPair> views, const StereoCalibration& camera,
               const Isometry3d& T_cam_lidar, double step) {
  Vector3d best = Vector3d::Zero();
  double strongest = strength(views, camera, T_cam_lidar);
  const auto try_step = [&](const Vector3d& more) {
    const double s = strength(views, camera, moved(T_cam_lidar, best + more));
    if (!(s > strongest) || (best + more).norm() > furthest_step) return false;
    strongest = s;
    best += more;
    return true;
  };
  while (step > last_step) {
    Vector3d together = -best;
    for (int i = 0; i < 3; ++i) {
      if (!try_step(step * Vector3d::Unit(i))) try_step(-step * Vector3d::Unit(i));
    }
    together += best;
    if (together.isZero()) {
      step /= 2.0;
      continue;
    }
    while (try_step(together)) {
    }
  }
  return best;
}

// Climbs from several places, since there is more than one summit.
Isometry3d strongest_pose(std::span<const ViewPair> views, const StereoCalibration& camera,
                          const Isometry3d& T_cam_lidar) {
  Isometry3d best = T_cam_lidar;
  double strongest = 0.0;
  for (const double turn : {0.0, -0.1, 0.1}) {
    for (const double right : {0.0, -0.2, 0.2}) {
      const Isometry3d start = moved(T_cam_lidar, {turn, right, 0.0});
      const Isometry3d pose = moved(start, climb(views, camera, start, first_step));
      const double s = strength(views, camera, pose);
      if (s > strongest) {
        strongest = s;
        best = pose;
      }
    }
  }
  return best;
}

}  // namespace

std::optional<HandEye> align_edges(std::span<const ViewPair> views, const StereoCalibration& camera,
                                   HandEye pose) {
  std::size_t edges = 0;
  for (const ViewPair& view : views) edges += view.scan->edges.size();
  if (edges < fewest_edges || views.size() < 2 * stretches) return std::nullopt;
  pose.T_a_b = strongest_pose(views, camera, pose.T_a_b);
  Eigen::Array3d squares = Eigen::Array3d::Zero();
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < stretches; ++i) {
    const std::size_t from = i * views.size() / stretches, to = (i + 1) * views.size() / stretches;
    const Vector3d apart =
        climb(views.subspan(from, to - from), camera, pose.T_a_b, first_step / 4.0);
    const double angle = apart.x() / turning_distance;
    const Vector3d found(angle, apart.y() - turning_distance * angle, apart.z());
    sum += found;
    squares += found.array().square();
  }
  const Eigen::Array3d sigma =
      ((squares - (sum / stretches).array().square() * stretches) / ((stretches - 1) * stretches))
          .sqrt();
  pose.rotation_covariance.row(1).setZero();
  pose.rotation_covariance.col(1).setZero();
  pose.rotation_covariance(1, 1) = sigma[0] * sigma[0] + edge_turn_error * edge_turn_error;
  pose.position_sigma.x() = std::hypot(sigma[1], edge_place_error);
  pose.position_sigma.z() = std::hypot(sigma[2], edge_place_error);
  pose.found = true;
  return pose;
}

}  // namespace maploop::extrinsics
