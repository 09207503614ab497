#include "sensors/velodyne/data_packet.h"

namespace maploop::sensors {

std::string_view to_string(PacketFault fault) {
  constexpr std::array<std::string_view, packet_fault_count> names{
      "none", "wrong size", "wrong block flag", "azimuth of 360 degrees or more",
      "from another model"};
  return names[static_cast<std::size_t>(fault)];
}

DataPacket DataPacket::check(std::span<const std::uint8_t> bytes, PacketFault& fault) {
  const DataPacket packet(bytes);
  fault = PacketFault::wrong_size;
  if (bytes.size() != velodyne_data_size) return packet;
  for (std::size_t block = 0; block < velodyne_blocks; ++block) {
    const std::uint16_t flag = packet.u16(100 * block);
    fault = PacketFault::wrong_block;
    if (flag != 0xeeff && flag != 0xddff) return packet;
    fault = PacketFault::wrong_azimuth;
    if (packet.azimuth(block) >= velodyne_full_turn) return packet;
  }
  fault = PacketFault::none;
  return packet;
}

std::optional<VelodyneModel> DataPacket::model() const {
  for (std::size_t block = 0; block < velodyne_blocks; ++block) {
    if (lower(block)) return VelodyneModel::hdl64e;
  }
  switch (bytes_[1205]) {
    case 0x21:
      return VelodyneModel::hdl32e;
    case 0x22:
      return VelodyneModel::vlp16;
    default:
      return std::nullopt;
  }
}

}  // namespace maploop::sensors
