#include <array>
#include <optional>
#include <stdexcept>
#include <utility>

#include "sensors/live/live_sensors.h"
#include "sensors/live/stream_source.h"
#include "sensors/velodyne/velodyne_decoder.h"

namespace maploop::sensors {
namespace {

class LiveVelodyne final : public StreamSource<LidarScan> {
 public:
  LiveVelodyne(LiveVelodyneOptions options, const HostClock& clock)
      : StreamSource(std::make_unique<Connection>(std::move(options.data)), clock),
        decoder_(options.model, std::move(options.lasers)) {
    if (options.position) position_.emplace(std::move(*options.position));
  }

  bool wait(LidarScan& scan, Duration patience) override {
    // Position packets are rare; the limit keeps a flood of them from delaying the data.
    for (int i = 0; position_ && i < max_positions; ++i) {
      const std::size_t size = position_->read(position_packet_, Duration::zero());
      if (size == 0) break;
      decoder_.add(std::span(position_packet_).first(size), clock().now(), scan);
    }
    return StreamSource::wait(scan, patience);
  }

 private:
  static constexpr int max_positions = 32;

  bool take(std::span<const std::uint8_t>& bytes, Time arrival, LidarScan& scan) override {
    if (bytes.empty() || !decoder_.add(std::exchange(bytes, {}), arrival, scan)) return false;
    const bool later = scan.stamp > last_stamp_ && scan.available > last_available_;
    if (!later) {
      ++out_of_order_;
      return false;
    }
    last_stamp_ = scan.stamp;
    last_available_ = scan.available;
    return true;
  }

  void describe(LiveReport& report) const override {
    const VelodyneCounts& counts = decoder_.counts();
    for (std::size_t i = 0; i < counts.refused.size(); ++i) {
      report.refuse(counts.refused[i],
                    "packets: " + std::string(to_string(static_cast<PacketFault>(i))));
    }
    report.lose(counts.lost, "packets lost");
    report.lose(counts.late, "packets late");
    report.lose(decoder_.turns().broken, "turns broken");
    report.lose(out_of_order_, "turns not later than the one before");
    report.note(counts.data, "data packets");
    report.note(counts.positions, "position packets");
    if (position_ && !position_->state().problem.empty()) {
      report.notes.push_back(position_->endpoint().text + ' ' + position_->state().problem);
    }
    const PacketClock& clock = decoder_.clock();
    report.clock = clock.offset().state(clock.gps_offset());
    report.clock.known = report.clock.known && clock.has_device_time();
    report.clock.jumps = clock.jumps();
  }

  std::optional<Connection> position_;
  std::array<std::uint8_t, 2048> position_packet_{};
  VelodyneDecoder decoder_;
  std::uint64_t out_of_order_ = 0;
  Time last_stamp_ = Time::min(), last_available_ = Time::min();
};

}  // namespace

std::unique_ptr<LiveSource<LidarScan>> listen_to_velodyne(LiveVelodyneOptions options,
                                                          const HostClock& clock) {
  for (const Endpoint* endpoint :
       {&options.data, options.position ? &*options.position : nullptr}) {
    if (endpoint != nullptr && endpoint->kind != Endpoint::Kind::udp) {
      throw std::invalid_argument("a Velodyne scanner sends datagrams; its endpoint '" +
                                  endpoint->text + "' must be udp://[ADDRESS]:PORT");
    }
  }
  return std::make_unique<LiveVelodyne>(std::move(options), clock);
}

}  // namespace maploop::sensors
