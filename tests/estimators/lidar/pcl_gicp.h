// PCL's GICP is a reference. Only pcl_gicp.cpp includes PCL.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "estimators/lidar/surface_point.h"

namespace maploop::testing {

// Uses PCL's defaults except for the distance between partners, and PCL's own neighbourhoods: only
// the positions of the points are used.
class PclGicp {
 public:
  explicit PclGicp(double max_distance = 1.0);
  ~PclGicp();

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

}  // namespace maploop::testing
