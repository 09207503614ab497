#include "tests/estimators/lidar/pcl_gicp.h"

#include <pcl/point_types.h>
#include <pcl/registration/gicp.h>

namespace maploop::testing {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

Cloud::Ptr cloud(const std::vector<lidar::SurfacePoint>& points) {
  Cloud::Ptr result(new Cloud);
  for (const lidar::SurfacePoint& p : points)
    result->push_back({p.position.x(), p.position.y(), p.position.z()});
  return result;
}

}  // namespace

struct PclGicp::Implementation {
  pcl::GeneralizedIterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> gicp;
};

PclGicp::PclGicp(double max_distance) : implementation_(std::make_unique<Implementation>()) {
  implementation_->gicp.setMaxCorrespondenceDistance(max_distance);
}

PclGicp::~PclGicp() = default;

PclGicp::Result PclGicp::align(const std::vector<lidar::SurfacePoint>& source,
                               const std::vector<lidar::SurfacePoint>& target,
                               const Eigen::Isometry3d& seed) {
  auto& gicp = implementation_->gicp;
  gicp.setInputSource(cloud(source));
  gicp.setInputTarget(cloud(target));
  Cloud aligned;
  gicp.align(aligned, seed.matrix().cast<float>());
  return {Eigen::Isometry3d(gicp.getFinalTransformation().cast<double>()), gicp.hasConverged()};
}

}  // namespace maploop::testing
