#include "tools/odometry/point_cloud.h"

#include <array>
#include <sstream>
#include <stdexcept>
#include <string>

#include "estimators/lidar/voxel_key.h"
#include "tools/evaluate/text_file.h"

namespace maploop::odometry {
namespace {

constexpr double cell_size = 0.15;  // m, one point of the cloud in each cell

lidar::LidarParameters fine(lidar::LidarParameters p) {
  p.sample_voxel = 0.2;
  p.max_samples = 200'000;
  return p;
}

std::string header(const std::filesystem::path& file, std::size_t count) {
  std::ostringstream out;
  if (file.extension() == ".ply") {
    out << "ply\nformat binary_little_endian 1.0\nelement vertex " << count << '\n';
    for (const char* name : {"x", "y", "z", "nx", "ny", "nz"})
      out << "property float " << name << '\n';
    out << "end_header\n";
  } else {
    out << "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n"
           "FIELDS x y z normal_x normal_y normal_z\nSIZE 4 4 4 4 4 4\nTYPE F F F F F F\n"
           "COUNT 1 1 1 1 1 1\nWIDTH "
        << count << "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " << count << "\nDATA binary\n";
  }
  return out.str();
}

}  // namespace

void check_cloud_name(const std::filesystem::path& file) {
  if (file.extension() != ".ply" && file.extension() != ".pcd")
    throw std::runtime_error("'" + file.string() + "': a cloud is written as .ply or .pcd");
}

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

void PointCloud::write(const std::filesystem::path& file) const {
  check_cloud_name(file);
  std::string text = header(file, points_.size());
  for (const lidar::SurfacePoint& point : points_) {
    for (const Eigen::Vector3f* v : {&point.position, &point.normal})
      text.append(reinterpret_cast<const char*>(v->data()), 3 * sizeof(float));
  }
  evaluation::write_text(file, text);
}

}  // namespace maploop::odometry
