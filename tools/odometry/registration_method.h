// The methods by which LiDAR odometry can register a scan.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "estimators/lidar/lidar_odometry.h"

namespace maploop::odometry {

enum class Method : std::uint8_t {
  gicp,            // the vehicle's (estimators/lidar/gicp.h)
  point_to_plane,  // the same partners, but with the distance along the map's normal alone
  pcl_gicp,
  pcl_ndt,
  pcl_icp,
};
constexpr std::array<std::string_view, 5> names_of(Method) {
  return {"gicp", "point-to-plane", "pcl-gicp", "pcl-ndt", "pcl-icp"};
}

// Returns whether the program was built with PCL, where the method is one of PCL.
bool available(Method method);

// Returns the registration of a method, which aligns the prepared scan with the local map. Only
// gicp's alignments have a covariance. Throws std::runtime_error, which states what to do, if the
// method is not available.
lidar::Registration registration_of(Method method, const lidar::LidarParameters& parameters);

}  // namespace maploop::odometry
