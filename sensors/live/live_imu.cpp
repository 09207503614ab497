#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "sensors/clock/clock_offset.h"
#include "sensors/imu/imu_line.h"
#include "sensors/imu/ncom.h"
#include "sensors/imu/xsens.h"
#include "sensors/live/line_splitter.h"
#include "sensors/live/live_sensors.h"
#include "sensors/live/stream_source.h"

namespace maploop::sensors {
namespace {

// The values of a sample are `delay` older than the unit's clock states.
class LiveImu : public StreamSource<ImuSample> {
 public:
  LiveImu(Endpoint endpoint, Duration delay, const HostClock& clock)
      : StreamSource(std::make_unique<Connection>(std::move(endpoint)), clock), delay_(delay) {}

 protected:
  void deliver(Time stamp, Time arrival, const InertialValues& values, ImuSample& sample) {
    StreamSource::deliver(stamp - delay_, arrival, sample);
    sample.values() = values;
  }
  bool is_later(Time stamp) const { return stamp - delay_ > last_stamp(); }

 private:
  Duration delay_;
};

class LiveImuLines final : public LiveImu {
 public:
  using LiveImu::LiveImu;

 private:
  bool take(std::span<const std::uint8_t>& bytes, Time arrival, ImuSample& sample) override {
    for (std::string_view line; lines_.next(bytes, line);) {
      const auto said = parse_imu_line(line);
      if (!said) {
        ++damaged_;
        continue;
      }
      offset_.add(said->time, arrival);
      const Time stamp = offset_.to_host(said->time);
      if (is_later(stamp)) {
        deliver(stamp, arrival, said->values, sample);
        return true;
      }
      ++repeated_;
    }
    return false;
  }
  void restart() override { lines_.restart(); }
  void describe(LiveReport& report) const override {
    report.refuse(damaged_, "lines that are not a sample");
    report.refuse(lines_.dropped(), "lines too long");
    report.refuse(repeated_, "samples not later than the one before");
    report.clock = offset_.state();
  }

  LineSplitter lines_;
  ClockOffset offset_;
  std::uint64_t damaged_ = 0, repeated_ = 0;
};

constexpr std::array<const char*, ncom_fault_count> reasons{"sound",
                                                            "with a wrong size",
                                                            "without a sync byte",
                                                            "with a wrong checksum",
                                                            "without inertial data",
                                                            "with a value out of range"};

class LiveNcom final : public LiveImu {
 public:
  using LiveImu::LiveImu;

 private:
  bool take(std::span<const std::uint8_t>& bytes, Time arrival, ImuSample& sample) override {
    if (bytes.empty()) return false;
    NcomFault fault{};
    const auto packet = parse_ncom(std::exchange(bytes, {}), fault);
    ++counts_[static_cast<std::size_t>(fault)];
    if (!packet) return false;
    const auto stamp = time_.stamp(packet->minute_ms, arrival);
    if (!stamp) {
      ++repeated_;
      return false;
    }
    deliver(*stamp, arrival, packet->values, sample);
    return true;
  }
  void describe(LiveReport& report) const override {
    for (std::size_t i = 1; i < counts_.size(); ++i) {
      report.refuse(counts_[i], std::string("packets ") + reasons[i]);
    }
    report.refuse(repeated_, "packets not later than the one before");
    report.clock = time_.offset().state();
  }

  NcomClock time_;
  std::array<std::uint64_t, ncom_fault_count> counts_{};
  std::uint64_t repeated_ = 0;
};

class LiveXsens final : public LiveImu {
 public:
  using LiveImu::LiveImu;

 private:
  bool take(std::span<const std::uint8_t>& bytes, Time arrival, ImuSample& sample) override {
    for (XsensSample said; decoder_.next(bytes, said);) {
      if (last_time_ && said.time <= *last_time_) {
        ++repeated_;
        continue;
      }
      last_time_ = said.time;
      offset_.add(said.time, arrival);
      const auto& [forward, left, up] = said.specific_force;
      const auto& [roll, pitch, yaw] = said.rate;
      deliver(offset_.to_host(said.time), arrival, {forward, left, yaw, true, up, roll, pitch},
              sample);
      return true;
    }
    return false;
  }
  void restart() override { decoder_.restart(); }
  void describe(LiveReport& report) const override {
    const XsensCounts& counts = decoder_.counts();
    report.refuse(counts.damaged, "messages with a wrong checksum, or too long");
    report.refuse(counts.incomplete,
                  "MTData2 without acceleration, rate of turn or SampleTimeFine");
    report.refuse(repeated_, "samples not later than the one before");
    report.note(counts.messages, "messages");
    report.clock = offset_.state();
  }

  XsensDecoder decoder_;
  ClockOffset offset_;
  std::uint64_t repeated_ = 0;
  std::optional<Duration> last_time_;  // of the unit's clock
};

}  // namespace

std::unique_ptr<LiveSource<ImuSample>> listen_to_imu_lines(Endpoint endpoint, Duration delay,
                                                           const HostClock& clock) {
  return std::make_unique<LiveImuLines>(std::move(endpoint), delay, clock);
}

std::unique_ptr<LiveSource<ImuSample>> listen_to_ncom(Endpoint endpoint, Duration delay,
                                                      const HostClock& clock) {
  if (endpoint.kind != Endpoint::Kind::udp) {
    throw std::invalid_argument("NCOM is read from datagrams; its endpoint '" + endpoint.text +
                                "' must be udp://[ADDRESS]:PORT");
  }
  return std::make_unique<LiveNcom>(std::move(endpoint), delay, clock);
}

std::unique_ptr<LiveSource<ImuSample>> listen_to_xsens(Endpoint endpoint, Duration delay,
                                                       const HostClock& clock) {
  return std::make_unique<LiveXsens>(std::move(endpoint), delay, clock);
}

}  // namespace maploop::sensors
