// PCL's GICP, as a reference. The only file that includes PCL is pcl_gicp.cpp.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "estimators/lidar/surface_point.h"

namespace maploop::testing {

// Its own defaults but for the distance between partners. Neighbourhoods are its own as well: of
// the points only the positions are used.
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
