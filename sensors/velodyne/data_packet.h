// This file views a Velodyne data packet: twelve blocks of 32 returns, the scanner's time, its
// factory bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "sensors/velodyne/model.h"

namespace maploop::sensors {

constexpr std::size_t velodyne_data_size = 1206;     // bytes of the UDP payload
constexpr std::size_t velodyne_blocks = 12;          // a packet
constexpr std::size_t velodyne_block_returns = 32;   // a block
constexpr std::uint32_t velodyne_full_turn = 36000;  // hundredths of a degree

enum class PacketFault : std::uint8_t { none, wrong_size, wrong_block, wrong_azimuth, other_model };
constexpr std::size_t packet_fault_count = 5;
std::string_view to_string(PacketFault fault);

struct VelodyneReturn {
  std::uint16_t range;  // 2 mm; 0 means no return
  std::uint8_t intensity;
};

// This is a view of a packet's bytes, which must outlive it.
class DataPacket {
 public:
  // Checks size, block flags and azimuths; `fault` is PacketFault::none if the packet is valid.
  static DataPacket check(std::span<const std::uint8_t> bytes, PacketFault& fault);

  std::uint32_t azimuth(std::size_t block) const { return u16(100 * block + 2); }  // 0.01 deg
  // Returns whether the block holds lasers 32 to 63 of an HDL-64E.
  bool lower(std::size_t block) const { return u16(100 * block) == 0xddff; }
  VelodyneReturn operator()(std::size_t block, std::size_t i) const {
    const std::size_t at = 100 * block + 4 + 3 * i;
    return {u16(at), bytes_[at + 2]};
  }

  // Microseconds since the hour, of the first firing. An HDL-64E of the first series has other data
  // there.
  std::uint32_t device_time() const {
    return u16(1200) | static_cast<std::uint32_t>(u16(1202)) << 16;
  }
  // Returns whether strongest and last returns alternate, two blocks a firing. Not valid for the
  // HDL-64E.
  bool dual_return() const { return bytes_[1204] == 0x39; }
  // Returns nothing if neither blocks nor factory bytes identify a known model.
  std::optional<VelodyneModel> model() const;

 private:
  explicit DataPacket(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  std::uint16_t u16(std::size_t at) const {
    return static_cast<std::uint16_t>(bytes_[at] | bytes_[at + 1] << 8);
  }

  std::span<const std::uint8_t> bytes_;
};

}  // namespace maploop::sensors
