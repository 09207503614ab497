#include <algorithm>
#include <utility>

#include "sensors/clock/clock_offset.h"
#include "sensors/imu/imu_line.h"
#include "sensors/live/line_connection.h"
#include "sensors/live/live_sensors.h"

namespace maploop::sensors {
namespace {

class LiveImuLines final : public LiveSource<ImuSample> {
 public:
  LiveImuLines(Endpoint endpoint, Duration delay, const HostClock& clock)
      : lines_(std::move(endpoint), clock), delay_(delay) {}

  bool wait(ImuSample& sample, Duration patience) override {
    return lines_.wait(
        patience, [&](std::string_view line, Time arrival) { return take(line, arrival, sample); });
  }

  LiveReport report() const override {
    LiveReport report{lines_.endpoint().text,
                      lines_.state(),
                      delivered_,
                      damaged_ + lines_.dropped() + repeated_,
                      {},
                      {},
                      {}};
    note_count(report.reasons, damaged_, "lines that are not a sample");
    note_count(report.reasons, lines_.dropped(), "lines too long");
    note_count(report.reasons, repeated_, "samples not later than the one before");
    report.clock = {offset_.known(), {}, offset_.drift(), offset_.delay(), jumps_};
    return report;
  }

 private:
  bool take(std::string_view line, Time arrival, ImuSample& sample) {
    const auto said = parse_imu_line(line);
    if (!said) {
      ++damaged_;
      return false;
    }
    if (offset_.add(said->time, arrival)) ++jumps_;
    const Time stamp = offset_.to_host(said->time) - delay_;
    if (stamp <= last_stamp_) {
      ++repeated_;
      return false;
    }
    sample.stamp = last_stamp_ = stamp;
    sample.available = last_available_ = std::max(arrival, last_available_ + Duration(1));
    sample.sequence = delivered_++;
    sample.specific_force_forward = said->specific_force_forward;
    sample.specific_force_left = said->specific_force_left;
    sample.yaw_rate = said->yaw_rate;
    return true;
  }

  LineConnection lines_;
  Duration delay_;
  ClockOffset offset_;
  std::uint64_t damaged_ = 0, repeated_ = 0, delivered_ = 0, jumps_ = 0;
  Time last_stamp_ = Time::min(), last_available_{};
};

}  // namespace

std::unique_ptr<LiveSource<ImuSample>> listen_to_imu_lines(Endpoint endpoint, Duration delay,
                                                           const HostClock& clock) {
  return std::make_unique<LiveImuLines>(std::move(endpoint), delay, clock);
}

}  // namespace maploop::sensors
