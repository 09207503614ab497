#include <bit>
#include <cstring>

#include "msgs/lcm/conversions.h"
#include "msgs/lcm/field_copy.h"

namespace maploop {

static_assert(sizeof(LidarPoint) == 16 && std::endian::native == std::endian::little,
              "points are copied as they are");

void convert(auto copy, Is<VehicleCalibration> auto& calibration, auto& m) {
  auto& stereo = calibration.stereo;
  copy(stereo.width, m.width);
  copy(stereo.height, m.height);
  copy(stereo.fx, m.fx);
  copy(stereo.fy, m.fy);
  copy(stereo.cx, m.cx);
  copy(stereo.cy, m.cy);
  copy(stereo.baseline, m.baseline);
  copy(stereo.T_body_cam.matrix(), m.T_body_cam);
  copy(calibration.T_body_velo.matrix(), m.T_body_velo);
  copy(calibration.rear_axle_distance, m.rear_axle_distance);
  copy(calibration.climb_offset, m.climb_offset);
  copy(calibration.climb_offset_sigma, m.climb_offset_sigma);
  copy(calibration.beam_elevation, m.beam_elevation);
  copy(calibration.fused.motion, m.motion);
  copy(calibration.fused.inertial, m.inertial);
  copy(calibration.fused.wheels, m.wheels);
  copy(calibration.fused.mems, m.mems);
  copy(calibration.peer_reference, m.peer_reference);
}
MAPLOOP_CONVERSIONS(VehicleCalibration, maploop_lcm::calibration_t)

void convert(auto copy, Is<Preview> auto& preview, auto& m) {
  copy.header(preview, m.header);
  copy(preview.width, m.width);
  copy(preview.height, m.height);
  copy.each(preview.jpeg, m.jpeg, m.jpeg_size);
  copy.column(preview.tracks, &Preview::Track::from_u, m.track_from_u);
  copy.column(preview.tracks, &Preview::Track::from_v, m.track_from_v);
  copy.column(preview.tracks, &Preview::Track::u, m.track_u);
  copy.column(preview.tracks, &Preview::Track::v, m.track_v);
  copy(preview.scan_stamp, m.scan_stamp_ns);
  copy.column(preview.points, &Preview::Point::x, m.point_x);
  copy.column(preview.points, &Preview::Point::y, m.point_y);
  copy.column(preview.points, &Preview::Point::z, m.point_z);
  if constexpr (copy.to_message) {
    m.track_count = static_cast<std::int32_t>(preview.tracks.size());
    m.point_count = static_cast<std::int32_t>(preview.points.size());
  }
}
MAPLOOP_CONVERSIONS(Preview, maploop_lcm::preview_t)

maploop_lcm::stereo_pair_t to_lcm(const StereoPair& pair) {
  if (pair.right.pixels.size() != pair.left.pixels.size()) {
    throw std::invalid_argument("the images of a pair differ in size");
  }
  maploop_lcm::stereo_pair_t m{};
  FieldCopy<true>{}.header(pair, m.header);
  m.width = pair.left.width;
  m.height = pair.left.height;
  m.size = static_cast<std::int32_t>(pair.left.pixels.size());
  m.left = pair.left.pixels;
  m.right = pair.right.pixels;
  return m;
}

void from_lcm(const maploop_lcm::stereo_pair_t& m, StereoPair& pair) {
  if (m.width < 0 || m.height < 0 || std::int64_t{m.width} * m.height != m.size) {
    throw std::invalid_argument("stereo_pair_t of " + std::to_string(m.width) + " x " +
                                std::to_string(m.height) + " pixels holds " +
                                std::to_string(m.size));
  }
  FieldCopy<false>{}.header(pair, m.header);
  pair.left.width = pair.right.width = m.width;
  pair.left.height = pair.right.height = m.height;
  pair.left.pixels = m.left;
  pair.right.pixels = m.right;
}

maploop_lcm::lidar_scan_t to_lcm(const LidarScan& scan) {
  maploop_lcm::lidar_scan_t m{};
  const FieldCopy<true> copy;
  copy.header(scan, m.header);
  copy(scan.start, m.start_ns);
  copy(scan.end, m.end_ns);
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(scan.points.data());
  m.points.assign(bytes, bytes + scan.points.size() * sizeof(LidarPoint));
  m.size = static_cast<std::int32_t>(m.points.size());
  m.times = scan.times;
  m.time_count = static_cast<std::int32_t>(m.times.size());
  return m;
}

void from_lcm(const maploop_lcm::lidar_scan_t& m, LidarScan& scan) {
  if (m.points.size() % sizeof(LidarPoint) != 0) {
    throw std::invalid_argument("lidar_scan_t holds " + std::to_string(m.points.size()) +
                                " bytes, no multiple of " + std::to_string(sizeof(LidarPoint)));
  }
  const std::size_t points = m.points.size() / sizeof(LidarPoint);
  if (!m.times.empty() && m.times.size() != points) {
    throw std::invalid_argument("lidar_scan_t holds " + std::to_string(m.times.size()) +
                                " times of " + std::to_string(points) + " points");
  }
  const FieldCopy<false> copy;
  copy.header(scan, m.header);
  copy(scan.start, m.start_ns);
  copy(scan.end, m.end_ns);
  scan.times = m.times;
  scan.points.resize(points);
  if (!m.points.empty()) std::memcpy(scan.points.data(), m.points.data(), m.points.size());
}

}  // namespace maploop
