#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "sensors/clock/clock_offset.h"
#include "sensors/imu/xsens.h"
#include "sensors/live/live_sensors.h"

namespace maploop::sensors {
namespace {

class LiveXsens final : public LiveSource<ImuSample> {
 public:
  LiveXsens(Endpoint endpoint, Duration delay, const HostClock& clock)
      : clock_(clock), connection_(std::move(endpoint)), delay_(delay) {}

  bool wait(ImuSample& sample, Duration patience) override {
    const Time end = clock_.now() + patience;
    do {
      for (XsensSample said; decoder_.next(unread_, said);) {
        if (take(said, sample)) return true;
      }
      const std::uint64_t opened = connection_.state().opened;
      const std::size_t size = connection_.read(buffer_, end - clock_.now());
      if (connection_.state().opened != opened) decoder_.restart();
      if (size == 0) return false;
      unread_ = std::span(buffer_).first(size);
      arrival_ = clock_.now();
    } while (clock_.now() < end);
    return false;
  }

  LiveReport report() const override {
    const XsensCounts& counts = decoder_.counts();
    LiveReport report{connection_.endpoint().text,
                      connection_.state(),
                      delivered_,
                      counts.damaged + counts.incomplete + repeated_,
                      {},
                      {},
                      {}};
    note_count(report.reasons, counts.damaged, "messages with a wrong checksum, or too long");
    note_count(report.reasons, counts.incomplete,
               "MTData2 without acceleration, rate of turn or SampleTimeFine");
    note_count(report.reasons, repeated_, "samples not later than the one before");
    note_count(report.notes, counts.messages, "messages");
    report.clock = {offset_.known(), {}, offset_.drift(), offset_.delay(), jumps_};
    return report;
  }

 private:
  bool take(const XsensSample& said, ImuSample& sample) {
    if (last_time_ && said.time <= *last_time_) {
      ++repeated_;
      return false;
    }
    last_time_ = said.time;
    if (offset_.add(said.time, arrival_)) ++jumps_;
    // Samples that arrive at once, as the first ones do, still belong to different moments.
    sample.stamp = last_stamp_ =
        std::max(offset_.to_host(said.time) - delay_, last_stamp_ + Duration(1));
    sample.available = last_available_ = std::max(arrival_, last_available_ + Duration(1));
    sample.sequence = delivered_++;
    sample.specific_force_forward = said.specific_force[0];
    sample.specific_force_left = said.specific_force[1];
    sample.yaw_rate = said.rate[2];
    return true;
  }

  const HostClock& clock_;
  Connection connection_;
  Duration delay_;
  XsensDecoder decoder_;
  std::array<std::uint8_t, 1024> buffer_{};
  std::span<const std::uint8_t> unread_;
  Time arrival_{};
  ClockOffset offset_;
  std::uint64_t repeated_ = 0, delivered_ = 0, jumps_ = 0;
  std::optional<Duration> last_time_;  // of the unit's clock
  Time last_stamp_{}, last_available_{};
};

}  // namespace

std::unique_ptr<LiveSource<ImuSample>> listen_to_xsens(Endpoint endpoint, Duration delay,
                                                       const HostClock& clock) {
  return std::make_unique<LiveXsens>(std::move(endpoint), delay, clock);
}

}  // namespace maploop::sensors
