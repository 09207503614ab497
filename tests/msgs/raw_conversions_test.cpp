// These tests pass raw sensors through the bytes of their messages.
#include "msgs/lcm/raw_conversions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace maploop {
namespace {

template <class Lcm>
Lcm through_bytes(const Lcm& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  const auto size = static_cast<int>(bytes.size());
  EXPECT_EQ(message.encode(bytes.data(), 0, size), size);
  Lcm decoded;
  EXPECT_EQ(decoded.decode(bytes.data(), 0, size), size);
  return decoded;
}

StereoPair pair_of(int width, int height) {
  StereoPair pair;
  pair.stamp = from_nanoseconds(1'317'042'651'174'740'992);
  pair.available = pair.stamp + Duration(5);
  pair.sequence = 7;
  pair.left.resize(width, height);
  pair.right.resize(width, height);
  for (std::size_t i = 0; i < pair.left.pixels.size(); ++i) {
    pair.left.pixels[i] = static_cast<std::uint8_t>(i * 7);
    pair.right.pixels[i] = static_cast<std::uint8_t>(i * 13);
  }
  return pair;
}

TEST(RawConversions, AStereoPairComesBackAsItWas) {
  const StereoPair pair = pair_of(31, 17);
  StereoPair back = pair_of(5, 5);  // buffers of another size
  from_lcm(through_bytes(to_lcm(pair)), back);
  EXPECT_EQ(back.stamp, pair.stamp);
  EXPECT_EQ(back.available, pair.available);
  EXPECT_EQ(back.sequence, pair.sequence);
  EXPECT_EQ(back.left.width, 31);
  EXPECT_EQ(back.right.height, 17);
  EXPECT_EQ(back.left.pixels, pair.left.pixels);
  EXPECT_EQ(back.right.pixels, pair.right.pixels);
}

TEST(RawConversions, APairWhoseSizesContradictIsRefused) {
  auto message = to_lcm(pair_of(4, 4));
  message.width = 5;
  StereoPair pair;
  EXPECT_THROW(from_lcm(message, pair), std::invalid_argument);
  message.width = -4;
  message.height = -4;
  EXPECT_THROW(from_lcm(message, pair), std::invalid_argument);
  StereoPair uneven = pair_of(4, 4);
  uneven.right.resize(3, 3);
  EXPECT_THROW(to_lcm(uneven), std::invalid_argument);
}

TEST(RawConversions, AScanComesBackAsItWasNanIncluded) {
  LidarScan scan;
  scan.stamp = from_nanoseconds(10);
  scan.start = from_nanoseconds(9);
  scan.end = scan.available = from_nanoseconds(11);
  scan.points = {{1.5F, -2.25F, 1e-30F, 0.5F}, {std::nanf(""), -0.0F, 3e38F, 1.0F}};
  LidarScan back;
  back.points.resize(9);
  from_lcm(through_bytes(to_lcm(scan)), back);
  EXPECT_EQ(back.start, scan.start);
  EXPECT_EQ(back.end, scan.end);
  ASSERT_EQ(back.points.size(), 2u);
  EXPECT_EQ(back.points[0].y, -2.25F);
  EXPECT_EQ(back.points[0].z, 1e-30F);
  EXPECT_TRUE(std::isnan(back.points[1].x));
  EXPECT_TRUE(std::signbit(back.points[1].y));

  scan.points.clear();
  from_lcm(through_bytes(to_lcm(scan)), back);
  EXPECT_TRUE(back.points.empty());

  auto message = to_lcm(scan);
  message.points.resize(15);
  EXPECT_THROW(from_lcm(message, back), std::invalid_argument);
}

TEST(RawConversions, ACalibrationComesBackToTheBit) {
  VehicleCalibration calibration;
  calibration.stereo.width = 1242;
  calibration.stereo.height = 375;
  calibration.stereo.fx = 721.5377;
  calibration.stereo.fy = 721.5378;
  calibration.stereo.cx = 609.5593;
  calibration.stereo.cy = 172.854;
  calibration.stereo.baseline = 0.5371657188644179;
  calibration.stereo.T_body_cam =
      Eigen::Translation3d(1.0, 2.0, 3.0) * Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX());
  calibration.T_body_velo = Eigen::Translation3d(0.1, 0.2, 0.3) * Eigen::Isometry3d::Identity();
  calibration.rear_axle_distance = 0.9;
  calibration.climb_offset = -0.01;
  calibration.climb_offset_sigma = 0.002;
  calibration.beam_elevation = 0.003;
  const VehicleCalibration back = from_lcm(through_bytes(to_lcm(calibration)));
  EXPECT_EQ(back.stereo.width, 1242);
  EXPECT_EQ(back.stereo.height, 375);
  EXPECT_EQ(back.stereo.fx, calibration.stereo.fx);
  EXPECT_EQ(back.stereo.fy, calibration.stereo.fy);
  EXPECT_EQ(back.stereo.cx, calibration.stereo.cx);
  EXPECT_EQ(back.stereo.cy, calibration.stereo.cy);
  EXPECT_EQ(back.stereo.baseline, calibration.stereo.baseline);
  EXPECT_EQ(back.stereo.T_body_cam.matrix(), calibration.stereo.T_body_cam.matrix());
  EXPECT_EQ(back.T_body_velo.matrix(), calibration.T_body_velo.matrix());
  EXPECT_EQ(back.rear_axle_distance, calibration.rear_axle_distance);
  EXPECT_EQ(back.climb_offset, calibration.climb_offset);
  EXPECT_EQ(back.climb_offset_sigma, calibration.climb_offset_sigma);
  EXPECT_EQ(back.beam_elevation, calibration.beam_elevation);
}

}  // namespace
}  // namespace maploop
