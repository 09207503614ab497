// Packets of a Velodyne scanner: whatever they are, scans are in order, finite and bounded.
#include <array>
#include <cmath>

#include "sensors/velodyne/velodyne_decoder.h"
#include "tests/fuzz/fuzz_input.h"

using namespace maploop;
using namespace maploop::sensors;

namespace {

// One block of the input is repeated, so that a short input is a whole packet.
void fill_packet(fuzz::Input& input, std::array<std::uint8_t, velodyne_data_size>& packet) {
  const std::uint32_t azimuth = input.number(), step = input.byte() * 4U;
  const auto returns = input.bytes(12);
  for (std::size_t block = 0; block < velodyne_blocks; ++block) {
    const std::size_t at = 100 * block;
    const std::uint32_t turned = (azimuth + static_cast<std::uint32_t>(block) * step) % 36500;
    packet[at] = (azimuth >> 30) == 3 ? 0xdd : 0xff;
    packet[at + 1] = (azimuth >> 30) == 3 ? 0xff : 0xee;
    if ((azimuth >> 30) == 3) std::swap(packet[at], packet[at + 1]);
    packet[at + 2] = static_cast<std::uint8_t>(turned);
    packet[at + 3] = static_cast<std::uint8_t>(turned >> 8);
    for (std::size_t i = 4; i < 100; ++i) {
      packet[at + i] = returns.empty() ? 0 : returns[i % returns.size()];
    }
  }
  for (std::size_t i = 1200; i < velodyne_data_size; ++i) packet[i] = input.byte();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  constexpr std::array models{VelodyneModel::vlp16, VelodyneModel::hdl32e, VelodyneModel::hdl64e};
  const VelodyneModel model = models[input.byte() % models.size()];
  VelodyneDecoder decoder(
      model, model == VelodyneModel::hdl64e ? std::vector<Laser>(64) : factory_lasers(model));
  Time arrival = parse_time("2026-03-01 10:59:59");
  LidarScan scan;
  std::array<std::uint8_t, velodyne_data_size> packet{};
  while (!input.empty()) {
    const std::uint8_t kind = input.byte();
    arrival += std::chrono::microseconds(input.number() % (kind < 250 ? 3000 : 4'000'000));
    bool ended = false;
    if (kind % 8 == 0) {
      ended = decoder.add(input.bytes(input.number() % 1300), arrival, scan);
    } else if (kind % 8 == 1) {
      std::array<std::uint8_t, velodyne_position_size> position{};
      const auto text = input.bytes(100);
      std::copy(text.begin(), text.end(), position.begin() + 198);
      ended = decoder.add(position, arrival, scan);
    } else {
      fill_packet(input, packet);
      ended = decoder.add(packet, arrival, scan);
    }
    if (!ended) continue;
    fuzz::require(scan.start < scan.end && scan.end <= scan.available);
    fuzz::require(!scan.points.empty() && scan.points.size() <= 480'000);
    for (const LidarPoint& p : scan.points) {
      fuzz::require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    }
  }
  return 0;
}
