#include "sensors/velodyne/velodyne_decoder.h"

#include <algorithm>
#include <utility>

namespace maploop::sensors {

VelodyneDecoder::VelodyneDecoder(VelodyneModel model, std::vector<Laser> lasers, Duration max_turn)
    : model_(model), decoder_(model, std::move(lasers)), assembler_(max_turn) {}

bool VelodyneDecoder::add(std::span<const std::uint8_t> payload, Time arrival, LidarScan& scan) {
  if (const auto position = parse_position_packet(payload)) {
    ++counts_.positions;
    clock_.add(*position);
    return false;
  }
  PacketFault fault{};
  const DataPacket packet = DataPacket::check(payload, fault);
  if (fault == PacketFault::none && packet.model().value_or(model_) != model_) {
    fault = PacketFault::other_model;
  }
  if (fault != PacketFault::none) {
    ++counts_.refused[static_cast<std::size_t>(fault)];
    return false;
  }
  const PacketTime time = clock_.stamp(packet.device_time(), decoder_.period(packet), arrival);
  if (time.late) {
    ++counts_.late;
    return false;
  }
  ++counts_.data;
  counts_.lost += time.lost;
  // This is a quarter of a turn at 10 Hz; a longer gap may hide several turns.
  constexpr Duration longest_gap = std::chrono::milliseconds(25);
  const Duration gap = time.first_firing - last_;
  if (std::chrono::abs(gap) > longest_gap) assembler_.interrupt();
  last_ = time.first_firing;

  bool ended = false;
  decoder_.decode(packet, [&](const FiredPoint& fired) {
    ++points_;
    ended |= assembler_.add(fired, time.first_firing + fired.offset, scan);
  });
  if (ended) scan.available = std::max(arrival, scan.end);
  return ended;
}

}  // namespace maploop::sensors
