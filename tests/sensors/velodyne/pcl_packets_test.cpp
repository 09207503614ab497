// These tests compare real packets with PCL, point by point.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "msgs/frames.h"
#include "sensors/velodyne/capture_reader.h"
#include "sensors/velodyne/packet_decoder.h"
#include "tests/sensors/velodyne/made_calibration.h"
#include "tests/sensors/velodyne/made_packets.h"
#include "tests/sensors/velodyne/pcl_packets.h"
#include "tests/support/real_data.h"

namespace maploop::sensors {
namespace {

struct Difference {
  std::size_t points = 0;
  double range = 0.0, elevation = 0.0;       // m, deg; largest
  double least_turn = 0.0, most_turn = 0.0;  // deg clockwise of PCL's point
  double position = 0.0;                     // m, largest
};

void compare(PacketDecoder& decoder, PclPackets& pcl, std::span<const std::uint8_t> bytes,
             Difference& worst) {
  PacketFault fault{};
  const DataPacket packet = DataPacket::check(bytes, fault);
  ASSERT_EQ(fault, PacketFault::none);
  std::vector<LidarPoint> ours;
  decoder.decode(packet, [&](const FiredPoint& fired) { ours.push_back(fired.point); });
  const std::vector<LidarPoint> theirs = pcl.decode(bytes);
  ASSERT_EQ(ours.size(), theirs.size());
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const LidarPoint &a = ours[i], &b = theirs[i];
    const auto range = [](const LidarPoint& p) { return std::hypot(p.x, p.y, p.z); };
    const auto elevation = [](const LidarPoint& p) {
      return degrees(std::atan2(p.z, std::hypot(p.x, p.y)));
    };
    const double turn = degrees(wrap_angle(std::atan2(b.y, b.x) - std::atan2(a.y, a.x)));
    worst.range = std::max<double>(worst.range, std::fabs(range(a) - range(b)));
    worst.elevation = std::max<double>(worst.elevation, std::fabs(elevation(a) - elevation(b)));
    worst.least_turn = std::min(worst.least_turn, turn);
    worst.most_turn = std::max(worst.most_turn, turn);
    worst.position = std::max<double>(worst.position, std::hypot(a.x - b.x, a.y - b.y, a.z - b.z));
    ASSERT_NEAR(a.reflectance * 255.0F, b.reflectance, 1e-3);
  }
  worst.points += ours.size();
}

Difference compare(PacketDecoder decoder, PclPackets pcl, const std::filesystem::path& file) {
  Difference worst;
  CaptureReader reader(file);
  for (CapturedPacket packet; reader.next(packet);) {
    if (packet.payload.size() == velodyne_data_size) compare(decoder, pcl, packet.payload, worst);
  }
  return worst;
}

// PCL gives all lasers of a firing sequence one azimuth, and ignores the vertical offsets.
TEST(PclPackets, Vlp16DiffersByTheTurnWithinASequence) {
  MAPLOOP_REQUIRE_REAL_DATA();
  std::vector<Laser> lasers = factory_lasers(VelodyneModel::vlp16);
  for (Laser& laser : lasers) laser.upwards = 0.0;
  const Difference d = compare(PacketDecoder(VelodyneModel::vlp16, lasers), PclPackets::vlp16(),
                               testing::real_data() / "velodyne/vlp16_moving_car.pcap");
  EXPECT_GT(d.points, 50'000U);
  EXPECT_LT(d.range, 1e-4);
  EXPECT_LT(d.elevation, 1e-3);
  // PCL rounds azimuths down to hundredths of a degree, and computes the turn between the two
  // sequences of every block from the packet's first block, where the encoder's steps differ by as
  // much again.
  constexpr double cut = 0.03, within_sequence = 0.2 * 15 * 2.304 / 55.296;
  EXPECT_GT(d.least_turn, -cut);
  EXPECT_LT(d.most_turn, within_sequence + cut);
}

// By the manual, a laser's vertical offset is perpendicular to its beam; PCL adds it straight up.
TEST(PclPackets, Hdl64eIsTheSameButForTheDirectionOfTheVerticalOffset) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "db.xml";
  write_calibration(file);
  std::vector<Laser> lasers = read_velodyne_calibration(file, VelodyneModel::hdl64e);
  for (Laser& laser : lasers) {
    laser.outwards = 0.0;
    laser.upwards /= laser.cos_elevation;
  }
  const Difference d =
      compare(PacketDecoder(VelodyneModel::hdl64e, lasers), PclPackets::hdl64e(file),
              testing::real_data() / "velodyne/hdl64e_static.pcap");
  EXPECT_GT(d.points, 50'000U);
  EXPECT_LT(d.position, 1e-4);
}

// No capture of one is available, so the packets are those of a made, standing scanner.
TEST(PclPackets, Hdl32eIsTheSame) {
  PacketDecoder decoder(VelodyneModel::hdl32e, factory_lasers(VelodyneModel::hdl32e));
  PclPackets pcl = PclPackets::hdl32e();
  Difference d;
  for (std::uint32_t azimuth = 0; azimuth < 36000; azimuth += 997) {
    compare(decoder, pcl, data_packet(azimuth, 0, azimuth, 5000, 0x37, 0x21), d);
  }
  EXPECT_GT(d.points, 10'000U);
  EXPECT_LT(d.range, 1e-4);
  EXPECT_LT(d.elevation, 0.005);  // PCL rounds them to hundredths of a degree
}

}  // namespace
}  // namespace maploop::sensors
