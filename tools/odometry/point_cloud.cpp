#include "tools/odometry/point_cloud.h"

#include "estimators/lidar/voxel_key.h"

namespace maploop::odometry {
namespace {

constexpr double cell_size = 0.15;  // m, one point of the cloud in each cell

lidar::LidarParameters fine(lidar::LidarParameters p) {
  p.sample_voxel = 0.2;
  p.max_samples = 200'000;
  return p;
}

}  // namespace

PointCloud::PointCloud(const Eigen::Isometry3d& T_body_velo,
                       const lidar::LidarParameters& parameters)
    : preparation_(T_body_velo, fine(parameters)) {}

void PointCloud::add(const LidarScan& scan, Time stamp, const lidar::Twist& motion,
                     const Eigen::Isometry3d& T_first_body) {
  preparation_.prepare(scan, stamp, motion, &prepared_);
  for (const lidar::SurfacePoint& point : prepared_.points) {
    const Eigen::Vector3d p = T_first_body * point.position.cast<double>();
    const Eigen::Vector3d cell = p / cell_size;
    const lidar::VoxelKey key =
        lidar::VoxelKey::of({lidar::floor_to_int(cell.x()), lidar::floor_to_int(cell.y()),
                             lidar::floor_to_int(cell.z())});
    if (!cells_.insert(key.bits).second) continue;
    points_.push_back({p.cast<float>(), T_first_body.linear().cast<float>() * point.normal});
  }
}

sensors::CloudTable table_of(const std::vector<lidar::SurfacePoint>& points) {
  sensors::CloudTable table{{"x", "y", "z", "normal_x", "normal_y", "normal_z"}, {}};
  for (const lidar::SurfacePoint& point : points) {
    for (const Eigen::Vector3f* v : {&point.position, &point.normal})
      table.values.insert(table.values.end(), v->begin(), v->end());
  }
  return table;
}

sensors::CloudTable table_of(const LidarScan& scan) {
  sensors::CloudTable table{{"x", "y", "z", "intensity"}, {}};
  const lidar::PointTimes time_of(scan, scan.stamp);
  const bool timed = to_seconds(scan.end - scan.start) > 1e-6;
  if (timed) table.fields.emplace_back("time");
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const LidarPoint& p = scan.points[i];
    table.values.insert(table.values.end(), {p.x, p.y, p.z, p.reflectance});
    if (timed) table.values.push_back(time_of(i));
  }
  return table;
}

}  // namespace maploop::odometry
