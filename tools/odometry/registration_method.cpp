#include "tools/odometry/registration_method.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>

#include "estimators/lidar/gicp_factor.h"
#include "estimators/lidar/scan_preparation.h"
#include "msgs/named_enum.h"
#include "tools/odometry/pcl_registration.h"

namespace maploop::odometry {
namespace {

using lidar::Alignment, lidar::LidarParameters, lidar::LocalMap, lidar::PreparedScan;

#if MAPLOOP_PCL
constexpr bool with_pcl = true;

lidar::Registration pcl_registration(Method method, const LidarParameters& parameters) {
  auto pcl = std::make_shared<PclRegistration>(method, parameters.max_distance);
  return [pcl, least = parameters.min_points](const LocalMap& map, const PreparedScan& scan,
                                              const Eigen::Isometry3d& seed, bool) {
    Alignment alignment;
    alignment.points = alignment.partners = static_cast<int>(scan.points.size());
    if (alignment.points < least) return alignment;
    const auto [T_map_body, converged] = pcl->align(scan.points, map.points(), seed);
    alignment.T_map_body = T_map_body;
    alignment.status = converged ? OdometryStatus::ok : OdometryStatus::not_converged;
    return alignment;
  };
}
#else
constexpr bool with_pcl = false;

lidar::Registration pcl_registration(Method, const LidarParameters&) {
  return {};
}
#endif

// Chen and Medioni, "Object modelling by registration of multiple range images", IVC 1992, with the
// distances, the kernel and the limits of the vehicle's GICP.
class PointToPlane {
 public:
  explicit PointToPlane(const LidarParameters& parameters) : p_(parameters) {}

  Alignment operator()(const LocalMap& map, const PreparedScan& scan, const Eigen::Isometry3d& seed,
                       bool known) const {
    Alignment result;
    result.T_map_body = seed;
    result.points = static_cast<int>(scan.points.size());
    if (result.points < p_.min_points) return result;
    double distance = known ? p_.max_distance : p_.unseeded_distance;
    result.status = OdometryStatus::not_converged;
    while (result.status != OdometryStatus::ok && result.iterations < most_iterations) {
      ++result.iterations;
      const lidar::Vector6d step = gauss_newton_step(map, scan, distance, &result);
      if (result.partners < p_.min_overlap * result.points) {
        result.status = OdometryStatus::too_few_inliers;
        return result;
      }
      result.T_map_body = result.T_map_body * lidar::Twist{step.head<3>(), step.tail<3>()}.over(1);
      if (distance <= p_.min_distance && step.head<3>().norm() < p_.translation_step &&
          step.tail<3>().norm() < p_.rotation_step)
        result.status = OdometryStatus::ok;
      distance = std::max(p_.min_distance, distance * (2.0 / 3.0));
    }
    return result;
  }

 private:
  static constexpr int most_iterations = 50;  // each is one step, with new partners

  lidar::Vector6d gauss_newton_step(const LocalMap& map, const PreparedScan& scan, double distance,
                                    Alignment* result) const {
    const double kernel = p_.kernel * distance / p_.min_distance * p_.point_sigma;
    const Eigen::Matrix3f R_body_map = result->T_map_body.linear().transpose().cast<float>();
    lidar::Matrix6f H = lidar::Matrix6f::Zero();
    lidar::Vector6f g = lidar::Vector6f::Zero();
    result->partners = 0;
    for (const lidar::SurfacePoint& point : scan.points) {
      const auto partner = map.nearest(result->T_map_body * point.position.cast<double>(),
                                       static_cast<float>(distance));
      if (!partner) continue;
      ++result->partners;
      const Eigen::Vector3f n = R_body_map * partner->normal;
      const Eigen::Vector3f d = R_body_map * partner->offset;
      const auto whitened = static_cast<float>(n.dot(d) / kernel);
      const float root = 1.0F / (1.0F + whitened * whitened);
      lidar::add_normal_equations(point.position, d, n * n.transpose(), root * root, &H, &g);
    }
    const lidar::Matrix6d full = lidar::Matrix6f(H.selfadjointView<Eigen::Lower>()).cast<double>();
    return -full.ldlt().solve(g.cast<double>());
  }

  LidarParameters p_;
};

}  // namespace

bool available(Method method) {
  return with_pcl || method == Method::gicp || method == Method::point_to_plane;
}

lidar::Registration registration_of(Method method, const LidarParameters& parameters) {
  if (!available(method))
    throw std::runtime_error("this maploop was built without PCL, which --method " +
                             std::string(to_string(method)) +
                             " needs: install libpcl-dev and build it again");
  if (method == Method::gicp) return {};
  if (method == Method::point_to_plane) return PointToPlane(parameters);
  return pcl_registration(method, parameters);
}

}  // namespace maploop::odometry
