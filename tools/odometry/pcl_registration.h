// Registers points with methods of PCL. Only pcl_registration.cpp includes PCL.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "estimators/lidar/surface_point.h"
#include "tools/odometry/registration_method.h"

namespace maploop::odometry {

// `method` is one of PCL. Uses only the positions of the points: GICP has PCL's own neighbourhoods.
// Parameters are PCL's defaults, but for the distance between partners, and for NDT those of PCL's
// tutorial (cells of 1 m, steps of 0.1 m, settled below 0.01 m).
class PclRegistration {
 public:
  explicit PclRegistration(Method method, double max_distance = 1.0);
  ~PclRegistration();

  struct Result {
    Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();
    bool converged = false;
  };
  Result align(const std::vector<lidar::SurfacePoint>& source,
               const std::vector<lidar::SurfacePoint>& target, const Eigen::Isometry3d& seed);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace maploop::odometry
