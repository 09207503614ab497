#include "tools/odometry/pcl_registration.h"

#include <pcl/point_types.h>
#include <pcl/registration/gicp.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/ndt.h>

namespace maploop::odometry {
namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;

Cloud::Ptr cloud(const std::vector<lidar::SurfacePoint>& points) {
  Cloud::Ptr result(new Cloud);
  for (const lidar::SurfacePoint& p : points)
    result->push_back({p.position.x(), p.position.y(), p.position.z()});
  return result;
}

std::unique_ptr<pcl::Registration<Point, Point>> make(Method method) {
  if (method == Method::pcl_gicp)
    return std::make_unique<pcl::GeneralizedIterativeClosestPoint<Point, Point>>();
  if (method == Method::pcl_icp)
    return std::make_unique<pcl::IterativeClosestPoint<Point, Point>>();
  auto ndt = std::make_unique<pcl::NormalDistributionsTransform<Point, Point>>();
  ndt->setResolution(1.0F);
  ndt->setStepSize(0.1);
  ndt->setTransformationEpsilon(0.01);
  return ndt;
}

}  // namespace

struct PclRegistration::Implementation {
  std::unique_ptr<pcl::Registration<Point, Point>> method;
};

PclRegistration::PclRegistration(Method method, double max_distance)
    : implementation_(std::make_unique<Implementation>(Implementation{make(method)})) {
  implementation_->method->setMaxCorrespondenceDistance(max_distance);
}

PclRegistration::~PclRegistration() = default;

PclRegistration::Result PclRegistration::align(const std::vector<lidar::SurfacePoint>& source,
                                               const std::vector<lidar::SurfacePoint>& target,
                                               const Eigen::Isometry3d& seed) {
  auto& method = *implementation_->method;
  method.setInputSource(cloud(source));
  method.setInputTarget(cloud(target));
  Cloud aligned;
  method.align(aligned, seed.matrix().cast<float>());
  return {Eigen::Isometry3d(method.getFinalTransformation().cast<double>()), method.hasConverged()};
}

}  // namespace maploop::odometry
