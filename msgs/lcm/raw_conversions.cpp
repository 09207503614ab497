#include "msgs/lcm/raw_conversions.h"

#include <bit>
#include <cstring>
#include <stdexcept>
#include <string>

#include "msgs/lcm/conversion_parts.h"

namespace maploop {
namespace {

static_assert(sizeof(LidarPoint) == 16 && std::endian::native == std::endian::little,
              "points are copied as they are");

void write_transform(const Eigen::Isometry3d& T, double (&out)[4][4]) {
  write<4>(Eigen::Matrix4d(T.matrix()), out);
}

void read_transform(const double (&in)[4][4], Eigen::Isometry3d& T) {
  Eigen::Matrix4d matrix;
  read<4>(in, matrix);
  T.matrix() = matrix;
}

}  // namespace

maploop_lcm::calibration_t to_lcm(const VehicleCalibration& calibration) {
  const StereoCalibration& c = calibration.stereo;
  maploop_lcm::calibration_t m{};
  m.width = c.width;
  m.height = c.height;
  m.fx = c.fx;
  m.fy = c.fy;
  m.cx = c.cx;
  m.cy = c.cy;
  m.baseline = c.baseline;
  write_transform(c.T_body_cam, m.T_body_cam);
  write_transform(calibration.T_body_velo, m.T_body_velo);
  m.rear_axle_distance = calibration.rear_axle_distance;
  m.climb_offset = calibration.climb_offset;
  m.climb_offset_sigma = calibration.climb_offset_sigma;
  m.beam_elevation = calibration.beam_elevation;
  return m;
}

VehicleCalibration from_lcm(const maploop_lcm::calibration_t& m) {
  VehicleCalibration calibration;
  StereoCalibration& c = calibration.stereo;
  c.width = m.width;
  c.height = m.height;
  c.fx = m.fx;
  c.fy = m.fy;
  c.cx = m.cx;
  c.cy = m.cy;
  c.baseline = m.baseline;
  read_transform(m.T_body_cam, c.T_body_cam);
  read_transform(m.T_body_velo, calibration.T_body_velo);
  calibration.rear_axle_distance = m.rear_axle_distance;
  calibration.climb_offset = m.climb_offset;
  calibration.climb_offset_sigma = m.climb_offset_sigma;
  calibration.beam_elevation = m.beam_elevation;
  return calibration;
}

maploop_lcm::stereo_pair_t to_lcm(const StereoPair& pair) {
  maploop_lcm::stereo_pair_t m{};
  m.header = header_of(pair);
  m.width = pair.left.width;
  m.height = pair.left.height;
  m.size = static_cast<std::int32_t>(pair.left.pixels.size());
  m.left = pair.left.pixels;
  m.right = pair.right.pixels;
  if (m.right.size() != m.left.size()) {
    throw std::invalid_argument("the images of a pair differ in size");
  }
  return m;
}

void from_lcm(const maploop_lcm::stereo_pair_t& m, StereoPair& pair) {
  if (m.width < 0 || m.height < 0 || std::int64_t{m.width} * m.height != m.size) {
    throw std::invalid_argument("stereo_pair_t of " + std::to_string(m.width) + " x " +
                                std::to_string(m.height) + " pixels holds " +
                                std::to_string(m.size));
  }
  set_sample(pair, m.header);
  for (GreyImage* image : {&pair.left, &pair.right}) {
    image->width = m.width;
    image->height = m.height;
  }
  pair.left.pixels = m.left;
  pair.right.pixels = m.right;
}

maploop_lcm::lidar_scan_t to_lcm(const LidarScan& scan) {
  maploop_lcm::lidar_scan_t m{};
  m.header = header_of(scan);
  m.start_ns = to_nanoseconds(scan.start);
  m.end_ns = to_nanoseconds(scan.end);
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(scan.points.data());
  m.points.assign(bytes, bytes + scan.points.size() * sizeof(LidarPoint));
  m.size = static_cast<std::int32_t>(m.points.size());
  return m;
}

void from_lcm(const maploop_lcm::lidar_scan_t& m, LidarScan& scan) {
  if (m.points.size() % sizeof(LidarPoint) != 0) {
    throw std::invalid_argument("lidar_scan_t holds " + std::to_string(m.points.size()) +
                                " bytes, no multiple of " + std::to_string(sizeof(LidarPoint)));
  }
  set_sample(scan, m.header);
  scan.start = from_nanoseconds(m.start_ns);
  scan.end = from_nanoseconds(m.end_ns);
  scan.points.resize(m.points.size() / sizeof(LidarPoint));
  if (!m.points.empty()) std::memcpy(scan.points.data(), m.points.data(), m.points.size());
}

}  // namespace maploop
