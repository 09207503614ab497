// LiDAR odometry in a loop of your own: prints where each scan was taken.
//   lidar_odometry 0000.bin 0001.bin ...      scans at 10 Hz, of x, y, z (m) and reflectance as
//   float32
#include <fstream>
#include <iostream>

#include "estimators/lidar/lidar_odometry.h"

int main(int count, char** files) {
  using namespace maploop;
  const Eigen::Isometry3d T_body_velo = Eigen::Isometry3d::Identity();  // poses are the scanner's
  lidar::LidarOdometry odometry(T_body_velo, lidar::LidarParameters{});
  LidarScan scan;
  for (int i = 1; i < count; ++i) {
    std::ifstream file(files[i], std::ios::binary);
    scan.points.clear();
    for (LidarPoint p; file.read(reinterpret_cast<char*>(&p), sizeof p);) scan.points.push_back(p);
    if (scan.points.empty()) {
      std::cerr << files[i] << " has no points\n";
      return 1;
    }
    scan.stamp = from_nanoseconds(1'000'000'000) + from_seconds(0.1 * i);
    scan.start = scan.stamp - from_seconds(0.05);
    scan.end = scan.available = scan.stamp + from_seconds(0.05);
    scan.sequence = static_cast<std::uint64_t>(i);
    const LidarMotion motion = odometry.process(&scan, nullptr).lidar;
    const Eigen::Vector3d place = odometry.pose().translation();
    std::cout << files[i] << ": " << to_string(motion.status) << ", " << place.transpose()
              << " m\n";
  }
  return count > 1 ? 0 : 1;
}
