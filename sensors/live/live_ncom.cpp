#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "sensors/imu/ncom.h"
#include "sensors/live/live_sensors.h"

namespace maploop::sensors {
namespace {

constexpr std::array<const char*, ncom_fault_count> reasons{"sound",
                                                            "with a wrong size",
                                                            "without a sync byte",
                                                            "with a wrong checksum",
                                                            "without inertial data",
                                                            "with a value out of range"};

class LiveNcom final : public LiveSource<ImuSample> {
 public:
  LiveNcom(Endpoint endpoint, Duration delay, const HostClock& clock)
      : clock_(clock), connection_(std::move(endpoint)), delay_(delay) {}

  bool wait(ImuSample& sample, Duration patience) override {
    const Time end = clock_.now() + patience;
    do {
      const std::size_t size = connection_.read(buffer_, end - clock_.now());
      if (size == 0) return false;
      const Time arrival = clock_.now();
      NcomFault fault{};
      const auto packet = parse_ncom(std::span(buffer_).first(size), fault);
      ++counts_[static_cast<std::size_t>(fault)];
      if (!packet) continue;
      const auto stamp = time_.stamp(packet->minute_ms, arrival);
      if (!stamp) {
        ++repeated_;
        continue;
      }
      sample.stamp = *stamp - delay_;
      sample.available = last_available_ = std::max(arrival, last_available_ + Duration(1));
      sample.sequence = delivered_++;
      sample.specific_force_forward = packet->specific_force_forward;
      sample.specific_force_left = packet->specific_force_left;
      sample.yaw_rate = packet->yaw_rate;
      return true;
    } while (clock_.now() < end);
    return false;
  }

  LiveReport report() const override {
    LiveReport report{connection_.endpoint().text, connection_.state(), delivered_, 0, {}, {}, {}};
    for (std::size_t i = 1; i < counts_.size(); ++i) {
      report.refused += counts_[i];
      note_count(report.reasons, counts_[i], std::string("packets ") + reasons[i]);
    }
    report.refused += repeated_;
    note_count(report.reasons, repeated_, "packets not later than the one before");
    note_count(report.reasons, connection_.state().too_large, "datagrams too large");
    const ClockOffset& offset = time_.offset();
    report.clock = {offset.known(), {}, offset.drift(), offset.delay(), time_.jumps()};
    return report;
  }

 private:
  const HostClock& clock_;
  Connection connection_;
  Duration delay_;
  NcomClock time_;
  std::array<std::uint8_t, 256> buffer_{};
  std::array<std::uint64_t, ncom_fault_count> counts_{};
  std::uint64_t repeated_ = 0;
  std::uint64_t delivered_ = 0;
  Time last_available_{};
};

}  // namespace

std::unique_ptr<LiveSource<ImuSample>> listen_to_ncom(Endpoint endpoint, Duration delay,
                                                      const HostClock& clock) {
  if (endpoint.kind != Endpoint::Kind::udp) {
    throw std::invalid_argument("NCOM is read from datagrams; its endpoint '" + endpoint.text +
                                "' must be udp://[ADDRESS]:PORT");
  }
  return std::make_unique<LiveNcom>(std::move(endpoint), delay, clock);
}

}  // namespace maploop::sensors
