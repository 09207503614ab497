// This file makes the packets that an HDL-64E would send from a turn that was recorded as points:
// the inverse of packet_decoder.h.
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

// States where a laser points: its angle from the horizontal, and the offset of its beam
// perpendicular to it, upwards from the scanner's centre.
struct LaserPlace {
  double elevation = 0.0;        // rad
  double vertical_offset = 0.0;  // m
};
using Hdl64Lasers = std::array<LaserPlace, 64>;

// KITTI's scans hold their points ordered by laser, each from the front leftwards. The points of a
// laser lie on a cone (to 1 mm), which is fitted:
//   height = distance tan(elevation) + vertical_offset / cos(elevation)
// Returns nothing if the points are not those of 64 lasers in that order, or one has too few.
std::optional<Hdl64Lasers> fit_lasers(std::span<const LidarPoint> points);

// Writes Velodyne's calibration file (db.xml) for programs that decode the packets. Throws
// std::runtime_error that names a file that cannot be written.
void write_velodyne_calibration(const std::filesystem::path& file, const Hdl64Lasers& lasers);

struct TimedPacket {
  Time first_firing{};
  std::array<std::uint8_t, velodyne_data_size> bytes{};

  // Sets the scanner's own time of the first firing: microseconds of the hour.
  void set_time(Time t);
};

struct EncodedTurn {
  std::vector<TimedPacket> packets;  // in the order of their times
  std::uint64_t points = 0;
  std::uint64_t crowded = 0;  // points left out: out of range, or firing taken
};

// All lasers fire together every 48 us, as in the unit. A point belongs to the laser with the
// nearest cone and to the firing nearest in azimuth (0.17 deg apart at 10 turns a second); its
// range is rounded to 2 mm. One thread at a time.
class Hdl64Encoder {
 public:
  explicit Hdl64Encoder(const Hdl64Lasers& lasers) : lasers_(lasers) {}

  // Makes the packets of a turn from the rear to the rear, replacing the contents of `turn`. Firing
  // times are the scan's own, which the bytes contain as microseconds of the hour.
  void encode(const LidarScan& scan, EncodedTurn& turn);

 private:
  std::size_t laser_of(const LidarPoint& point, double distance) const;

  Hdl64Lasers lasers_;
  std::vector<VelodyneReturn> returns_;  // for each firing and laser
};

}  // namespace maploop::sensors
