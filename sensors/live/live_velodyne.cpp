#include <array>
#include <stdexcept>
#include <utility>

#include "sensors/live/live_sensors.h"
#include "sensors/velodyne/velodyne_decoder.h"

namespace maploop::sensors {
namespace {

class LiveVelodyne final : public LiveSource<LidarScan> {
 public:
  LiveVelodyne(LiveVelodyneOptions options, const HostClock& clock)
      : clock_(clock),
        data_(std::move(options.data)),
        decoder_(options.model, std::move(options.lasers)) {
    if (options.position) position_.emplace(std::move(*options.position));
  }

  bool wait(LidarScan& scan, Duration patience) override {
    // Position packets are rare; the limit keeps a flood of them from delaying the data.
    for (int i = 0; position_ && i < max_positions; ++i) {
      const std::size_t size = position_->read(buffer_, Duration::zero());
      if (size == 0) break;
      decoder_.add(std::span(buffer_).first(size), clock_.now(), scan);
    }
    // A turn has 75 packets or more: the loop returns after `patience` even if there is more to
    // read.
    const Time end = clock_.now() + patience;
    do {
      const std::size_t size = data_.read(buffer_, end - clock_.now());
      if (size == 0) return false;
      if (decoder_.add(std::span(buffer_).first(size), clock_.now(), scan) && in_order(scan)) {
        ++delivered_;
        return true;
      }
    } while (clock_.now() < end);
    return false;
  }

  LiveReport report() const override {
    LiveReport report{data_.endpoint().text, data_.state(), delivered_, 0, {}, {}, {}};
    const VelodyneCounts& counts = decoder_.counts();
    for (std::size_t i = 0; i < counts.refused.size(); ++i) {
      report.refused += counts.refused[i];
      note_count(report.reasons, counts.refused[i],
                 "packets: " + std::string(to_string(static_cast<PacketFault>(i))));
    }
    note_count(report.reasons, data_.state().too_large, "datagrams too large");
    note_count(report.reasons, counts.lost, "packets lost");
    note_count(report.reasons, counts.late, "packets late");
    note_count(report.reasons, decoder_.turns().broken, "turns broken");
    note_count(report.reasons, out_of_order_, "turns not later than the one before");
    note_count(report.notes, counts.data, "data packets");
    note_count(report.notes, counts.positions, "position packets");
    if (position_ && !position_->state().problem.empty()) {
      report.notes.push_back(position_->endpoint().text + ' ' + position_->state().problem);
    }
    const PacketClock& clock = decoder_.clock();
    report.clock = {clock.has_device_time() && clock.offset().known(), clock.gps_offset(),
                    clock.offset().drift(), clock.offset().delay(), clock.jumps()};
    return report;
  }

 private:
  static constexpr int max_positions = 32;

  bool in_order(const LidarScan& scan) {
    const bool later = scan.stamp > last_stamp_ && scan.available > last_available_;
    if (!later) {
      ++out_of_order_;
      return false;
    }
    last_stamp_ = scan.stamp;
    last_available_ = scan.available;
    return true;
  }

  const HostClock& clock_;
  Connection data_;
  std::optional<Connection> position_;
  VelodyneDecoder decoder_;
  std::array<std::uint8_t, 2048> buffer_{};
  std::uint64_t delivered_ = 0;
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
