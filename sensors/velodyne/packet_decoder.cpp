#include "sensors/velodyne/packet_decoder.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "msgs/frames.h"

namespace maploop::sensors {
namespace {

// The times are from the user's manuals: VLP-16 section 9.3, HDL-32E section 9.3, HDL-64E S2
// appendix (288 us a packet).
struct Timing {
  Duration block;     // from one block to the next
  Duration sequence;  // in which all lasers fire once
  Duration laser;     // from one laser to the next
};

Timing timing(VelodyneModel model) {
  switch (model) {
    case VelodyneModel::vlp16:
      return {Duration(110'592), Duration(55'296), Duration(2'304)};
    case VelodyneModel::hdl32e:
      return {Duration(46'080), Duration(46'080), Duration(1'152)};
    default:
      return {Duration(24'000), Duration(24'000), Duration(0)};
  }
}

}  // namespace

PacketDecoder::PacketDecoder(VelodyneModel model, std::vector<Laser> lasers)
    : model_(model), lasers_(std::move(lasers)) {
  if (lasers_.size() != laser_count(model)) {
    throw std::logic_error("wrong number of lasers for a " + std::string(to_string(model)));
  }
  for (std::uint32_t i = 0; i <= velodyne_full_turn * 5 / 4; ++i) {
    sines_.push_back(static_cast<float>(std::sin(radians(0.01 * i))));
  }
  const Timing t = timing(model);
  const std::size_t a_sequence = std::min(lasers_.size(), velodyne_block_returns);
  for (std::size_t i = 0; i < velodyne_block_returns; ++i) {
    in_block_.push_back(static_cast<int>(i / a_sequence) * t.sequence +
                        static_cast<int>(i % a_sequence) * t.laser);
  }
}

bool PacketDecoder::is_dual(const DataPacket& packet) const {
  return model_ != VelodyneModel::hdl64e && packet.dual_return();
}

Duration PacketDecoder::period(const DataPacket& packet) const {
  return static_cast<int>(velodyne_blocks) / (is_dual(packet) ? 2 : 1) * timing(model_).block;
}

Duration PacketDecoder::block_time(std::size_t block) const {
  return static_cast<int>(dual_ ? block / 2 : block) * timing(model_).block;
}

void PacketDecoder::begin(const DataPacket& packet) {
  dual_ = is_dual(packet);
  const std::size_t step = dual_ ? 2 : 1;
  double rate = 0.0;
  for (std::size_t block = 0; block < velodyne_blocks; block += step) {
    if (block + step < velodyne_blocks) {
      const std::uint32_t turned =
          (packet.azimuth(block + step) + velodyne_full_turn - packet.azimuth(block)) %
          velodyne_full_turn;
      // A larger step is a backward one by the encoder's noise, or invalid data: no rate is used.
      rate = turned < velodyne_full_turn / 4
                 ? turned / static_cast<double>(timing(model_).block.count())
                 : 0.0;
    }
    rate_[block] = rate;
  }
}

FiredPoint PacketDecoder::place(const DataPacket& packet, std::size_t block, std::size_t i,
                                VelodyneReturn found) const {
  constexpr double range_unit = 2e-3;
  const std::size_t number = packet.lower(block) && model_ == VelodyneModel::hdl64e
                                 ? i + velodyne_block_returns
                                 : i % lasers_.size();
  const Laser& laser = lasers_[number];
  double azimuth = packet.azimuth(block) + rate_[block] * static_cast<double>(in_block_[i].count());
  if (azimuth >= velodyne_full_turn) azimuth -= velodyne_full_turn;

  const auto whole = static_cast<std::size_t>(azimuth);
  const double part = azimuth - static_cast<double>(whole);
  const auto sine_at = [&](std::size_t at) {
    return (1.0 - part) * sines_[at] + part * sines_[at + 1];
  };
  const double sine = sine_at(whole), cosine = sine_at(whole + velodyne_full_turn / 4);
  const double s = sine * laser.cos_azimuth_correction - cosine * laser.sin_azimuth_correction;
  const double c = cosine * laser.cos_azimuth_correction + sine * laser.sin_azimuth_correction;

  const double range = range_unit * found.range + laser.range_correction;
  const double across = range * laser.cos_elevation + laser.outwards;
  FiredPoint fired;
  fired.point.x = static_cast<float>(across * c + laser.sideways * s);
  fired.point.y = static_cast<float>(laser.sideways * c - across * s);
  fired.point.z = static_cast<float>(range * laser.sin_elevation + laser.upwards);
  fired.point.reflectance = static_cast<float>(found.intensity) / 255.0F;
  fired.azimuth = azimuth;
  fired.offset = block_time(block) + in_block_[i];
  return fired;
}

}  // namespace maploop::sensors
