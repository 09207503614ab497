// Packets as an HDL-64E sends them, out of a turn that was recorded as points: the other way round
// than packet_decoder.h.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "msgs/lidar_scan.h"
#include "sensors/velodyne/data_packet.h"

namespace maploop::sensors {

// Where a laser points: from the horizontal, and how far above the scanner's centre it sits.
struct LaserPlace {
  double elevation = 0.0;        // rad
  double vertical_offset = 0.0;  // m
};
using Hdl64Lasers = std::array<LaserPlace, 64>;

// KITTI's scans hold their points laser by laser, each from the front leftwards: the cone that they
// lie on, height = distance tan(elevation) + offset, is the laser's (to 1 mm). Nothing where the
// points are not those of 64 lasers in such an order, or one has too few.
std::optional<Hdl64Lasers> fit_lasers(std::span<const LidarPoint> points);

// Velodyne's calibration file (db.xml), for whoever decodes the packets. Throws std::runtime_error
// naming the file that cannot be written.
void write_velodyne_calibration(const std::filesystem::path& file, const Hdl64Lasers& lasers);

struct TimedPacket {
  Time first_firing{};
  std::array<std::uint8_t, velodyne_data_size> bytes{};

  // The scanner's own time of the first firing: microseconds of the hour.
  void set_time(Time t);
};

struct EncodedTurn {
  std::vector<TimedPacket> packets;  // in the order of their times
  std::uint64_t points = 0;
  std::uint64_t crowded = 0;  // points left out: another of their laser has the firing
};

// One firing of all lasers every 48 us, as the unit does: a point goes to the firing nearest in
// azimuth (0.17 deg apart at 10 turns a second), its range is rounded to 2 mm. A point belongs to
// the laser whose cone it is nearest to. One thread at a time.
class Hdl64Encoder {
 public:
  explicit Hdl64Encoder(const Hdl64Lasers& lasers) : lasers_(lasers) {}

  // The packets of a turn from the rear to the rear, in place of those of another. Firing times are
  // the scan's own, which the bytes hold as microseconds of the hour.
  void encode(const LidarScan& scan, EncodedTurn& turn);

 private:
  std::size_t laser_of(const LidarPoint& point, double distance) const;

  Hdl64Lasers lasers_;
  std::vector<VelodyneReturn> returns_;  // of each firing and laser
};

}  // namespace maploop::sensors
