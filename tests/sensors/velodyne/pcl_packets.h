// This file decodes Velodyne packets with PCL.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "msgs/lidar_scan.h"

namespace maploop::sensors {

class PclPackets {
 public:
  static PclPackets vlp16();
  static PclPackets hdl32e();
  static PclPackets hdl64e(const std::filesystem::path& calibration);
  ~PclPackets();
  PclPackets(PclPackets&&) noexcept;

  // Returns the points of one packet in PCL's order, in our axes; reflectance 0..255.
  std::vector<LidarPoint> decode(std::span<const std::uint8_t> packet);

 private:
  struct Grabber;
  explicit PclPackets(std::unique_ptr<Grabber> grabber);
  std::unique_ptr<Grabber> grabber_;
};

}  // namespace maploop::sensors
