// A Velodyne data packet: twelve blocks of 32 returns, the scanner's time, its factory bytes.
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
  std::uint16_t range;  // 2 mm; 0: nothing came back
  std::uint8_t intensity;
};

// A view of a packet's bytes, which must outlive it.
class DataPacket {
 public:
  // Looks at size, block flags and azimuths; `fault` is none where they are a packet's.
  static DataPacket check(std::span<const std::uint8_t> bytes, PacketFault& fault);

  std::uint32_t azimuth(std::size_t block) const { return u16(100 * block + 2); }  // 0.01 deg
  // Of the HDL-64E: lasers 32 to 63.
  bool lower(std::size_t block) const { return u16(100 * block) == 0xddff; }
  VelodyneReturn operator()(std::size_t block, std::size_t i) const {
    const std::size_t at = 100 * block + 4 + 3 * i;
    return {u16(at), bytes_[at + 2]};
  }

  // Microseconds since the hour, of the first firing. An HDL-64E of the first series has other
  // things there.
  std::uint32_t device_time() const {
    return u16(1200) | static_cast<std::uint32_t>(u16(1202)) << 16;
  }
  // Strongest and last return in turn, two blocks a firing. Not of the HDL-64E.
  bool dual_return() const { return bytes_[1204] == 0x39; }
  // Nothing where neither blocks nor factory bytes are those of a known one.
  std::optional<VelodyneModel> model() const;

 private:
  explicit DataPacket(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  std::uint16_t u16(std::size_t at) const {
    return static_cast<std::uint16_t>(bytes_[at] | bytes_[at + 1] << 8);
  }

  std::span<const std::uint8_t> bytes_;
};

}  // namespace maploop::sensors
