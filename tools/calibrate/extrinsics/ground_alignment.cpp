#include "tools/calibrate/extrinsics/ground_alignment.h"

#include <array>
#include <cmath>

#include "estimators/lidar/local_map.h"
#include "msgs/small_turn.h"
#include "tools/calibrate/extrinsics/robust_fit.h"

namespace maploop::extrinsics {
namespace {

using Eigen::Isometry3d, Eigen::Matrix3d, Eigen::Vector3d;

constexpr int least_equations = 200;
constexpr double block = 4.0;           // s, whose errors belong together
constexpr double upright = 0.9;         // cosine of 25 deg
constexpr double image_sigma = 0.3;     // px, of a disparity
constexpr double surface_sigma = 0.05;  // m
constexpr double ground_turn_error = 0.001, ground_height_error = 0.01;  // rad, m
// Search distances (m) of the rounds, from what odometry leaves open to what images show.
constexpr std::array rounds{1.0, 1.0, 0.7, 0.5, 0.3, 0.3, 0.3, 0.3};

// Adds the equations of one view, each in units of its own standard deviation. Unknown are the
// turns about right and ahead, the place downward, and the offset of the disparities.
void add_equations(const ViewPair& view, const StereoCalibration& camera,
                   const lidar::LocalMap& map, const Isometry3d& T_cam_lidar, double offset,
                   double distance, std::vector<Equation>& equations) {
  const Matrix3d R_scan_cam = view.T_scan_image.linear() * T_cam_lidar.linear().transpose();
  for (stereo::ImagePoint seen : view.image->points) {
    seen.z() += offset;
    if (seen.z() < 1.0) continue;
    const Vector3d p = stereo::triangulate(camera, seen);
    const Vector3d from_lidar = p - T_cam_lidar.translation();
    const Vector3d in_scan = R_scan_cam * from_lidar + view.T_scan_image.translation();
    const auto partner = map.nearest(in_scan, static_cast<float>(distance));
    if (!partner) continue;
    const Vector3d n = R_scan_cam.transpose() * partner->normal.cast<double>();  // in cam
    if (std::abs(n.y()) < upright) continue;
    const double by_disparity = n.dot(stereo::triangulate_by_disparity(p, seen.z()));
    const double sigma = std::hypot(surface_sigma, image_sigma * by_disparity);
    const Vector3d by_turn = n.cross(from_lidar);
    const Eigen::RowVector4d J(by_turn.x(), by_turn.z(), -n.y(), by_disparity);
    const Eigen::Matrix<double, 1, 1> residual(partner->normal.dot(partner->offset) / sigma);
    equations.push_back({J / sigma, residual, static_cast<int>(view.time / block)});
  }
}

}  // namespace

std::optional<HandEye> align_ground(std::span<const ViewPair> views,
                                    const StereoCalibration& camera, HandEye pose) {
  const Eigen::Vector4d sigma(0.05, 0.05, 3.0, 0.5);  // before: rad, m, px
  Eigen::VectorXd known = Eigen::VectorXd::Zero(4);
  lidar::LocalMap map{lidar::LidarParameters()};
  Fit fit;
  for (const double distance : rounds) {
    std::vector<Equation> equations;
    for (const ViewPair& view : views) {
      map.clear();
      map.insert(view.scan->surfaces, Isometry3d::Identity());
      add_equations(view, camera, map, pose.T_a_b, known[3], distance, equations);
    }
    if (static_cast<int>(equations.size()) < least_equations) return std::nullopt;
    fit = robust_fit(equations, known, sigma);
    known += fit.step;
    pose.T_a_b.linear() =
        rotation_of(Vector3d(fit.step[0], 0.0, fit.step[1])) * pose.T_a_b.linear();
    pose.T_a_b.translation().y() += fit.step[2];
  }
  const Eigen::Matrix2d turns = fit.covariance.topLeftCorner<2, 2>() +
                                ground_turn_error * ground_turn_error * Eigen::Matrix2d::Identity();
  const double about_down = pose.rotation_covariance(1, 1);
  pose.rotation_covariance << turns(0, 0), 0.0, turns(0, 1), 0.0, about_down, 0.0, turns(1, 0), 0.0,
      turns(1, 1);
  pose.position_sigma.y() = std::hypot(std::sqrt(fit.covariance(2, 2)), ground_height_error);
  pose.found = true;
  return pose;
}

}  // namespace maploop::extrinsics
