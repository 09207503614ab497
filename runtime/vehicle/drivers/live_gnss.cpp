#include "runtime/vehicle/drivers/live_gnss.h"

#include <algorithm>
#include <array>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "ppp/filter/measurement.h"
#include "ppp/readers/corrections/correction_stream.h"
#include "ppp/readers/streams/pvt_stream.h"
#include "ppp/readers/streams/receiver_stream.h"
#include "sensors/clock/clock_offset.h"
#include "sensors/live/stream_source.h"

namespace maploop::vehicle {
namespace {

// Maps the times of a receiver's epochs to the host's clock.
class EpochClock {
 public:
  explicit EpochClock(Duration latency) : latency_(latency) {}

  Time on_host(ppp::GpsTime time, Time arrival) {
    const Duration utc = ppp::to_utc(time).time_since_epoch();
    offset_.add(utc, arrival - latency_);
    const Time host = offset_.to_host(utc);
    utc_ahead_ = utc - host.time_since_epoch();
    return host;
  }
  SensorClock state() const { return offset_.state(utc_ahead_); }

 private:
  Duration latency_;
  sensors::ClockOffset offset_;
  std::optional<Duration> utc_ahead_;
};

class LiveFixes final : public sensors::StreamSource<GnssFix> {
 public:
  LiveFixes(std::unique_ptr<sensors::ByteStream> receiver, Duration latency,
            const sensors::HostClock& clock)
      : StreamSource(std::move(receiver), clock), epochs_(latency) {}

 private:
  bool take(std::span<const std::uint8_t>& bytes, Time arrival, GnssFix& fix) override {
    if (!bytes.empty()) stream_.push(std::exchange(bytes, {}));
    while (stream_.next(pvt_)) {
      if (pvt_.fix) {
        fill(fix, arrival);
        return true;
      }
      ++no_fix_;
    }
    return false;
  }

  void restart() override { stream_.restart(); }

  void describe(sensors::LiveReport& report) const override {
    const ppp::PvtStreamCounts& counts = stream_.counts();
    report.refuse(counts.damaged, "frames with a wrong checksum, or incomplete");
    report.refuse(counts.unusable, "NAV-PVT with inconsistent content");
    report.refuse(counts.repeated, "epochs not later than the one before");
    report.lose(no_fix_, "epochs without a fix");
    report.note(counts.frames, "UBX frames");
    if (delivered() > 0)
      report.notes.push_back("last fix: " + std::to_string(satellites_) + " satellites");
    report.clock = epochs_.state();
  }

  void fill(GnssFix& fix, Time arrival) {
    deliver(epochs_.on_host(pvt_.time, arrival), arrival, fix);
    satellites_ = pvt_.satellites;
    fix.position = pvt_.position;
    fix.velocity_stamp = fix.stamp;
    fix.velocity_enu = pvt_.velocity_enu;
    const double horizontal = pvt_.horizontal_sigma * pvt_.horizontal_sigma / 2.0;
    fix.position_covariance =
        Eigen::Vector3d(horizontal, horizontal, pvt_.vertical_sigma * pvt_.vertical_sigma)
            .asDiagonal();
    // The message does not state how the speed's error is spread over the axes: each gets all of
    // it.
    fix.velocity_covariance =
        Eigen::Vector3d::Constant(pvt_.speed_sigma * pvt_.speed_sigma).asDiagonal();
  }

  EpochClock epochs_;
  ppp::PvtStream stream_;
  ppp::UbxPvt pvt_;
  int satellites_ = 0;  // in the last fix
  std::uint64_t no_fix_ = 0;
};

// Returns "last epoch: 9 G, 7 E; 14 on two carriers".
std::string in_view(const ppp::Epoch& epoch) {
  std::array<int, ppp::system_count> satellites{};
  int dual = 0;
  for (const ppp::SatelliteSignals& s : epoch.satellites) {
    ++satellites[static_cast<std::size_t>(s.satellite.system)];
    const auto bands = ppp::bands_of(s.satellite.system);
    const auto signals = epoch.of(s);
    dual += std::all_of(bands.begin(), bands.end(), [&](char band) {
      return std::any_of(signals.begin(), signals.end(),
                         [band](const ppp::Signal& signal) { return signal.band == band; });
    });
  }
  std::string text;
  for (std::size_t i = 0; i < satellites.size(); ++i) {
    if (satellites[i] == 0) continue;
    text += (text.empty() ? "" : ", ") + std::to_string(satellites[i]) + ' ' +
            ppp::letter(static_cast<ppp::System>(i));
  }
  return "last epoch: " + text + "; " + std::to_string(dual) + " on two carriers";
}

class LiveReceiver final : public sensors::StreamSource<GnssEpoch> {
 public:
  LiveReceiver(std::unique_ptr<sensors::ByteStream> receiver, Duration latency,
               const sensors::HostClock& clock)
      : StreamSource(std::move(receiver), clock),
        epochs_(latency),
        stream_(ppp::from_utc(clock.now())) {}

 private:
  bool take(std::span<const std::uint8_t>& bytes, Time arrival, GnssEpoch& sample) override {
    if (!bytes.empty()) stream_.push(std::exchange(bytes, {}));
    if (!stream_.next(epoch_)) return false;
    deliver(epochs_.on_host(epoch_.time, arrival), arrival, sample);
    last_ = epoch_;
    std::swap(sample.epoch, epoch_);
    sample.heard.take(stream_.navigation());
    for (const auto& m : sample.heard.kepler) satellites_.insert(m.satellite);
    for (const auto& m : sample.heard.glonass) satellites_.insert(m.satellite);
    return true;
  }

  void restart() override { stream_.restart(); }

  void describe(sensors::LiveReport& report) const override {
    const ppp::ReceiverStreamCounts counts = stream_.counts();
    report.refuse(counts.damaged, "frames with a wrong checksum, or incomplete");
    report.refuse(counts.unusable, "messages with inconsistent content");
    report.refuse(counts.repeated, "epochs not later than the one before");
    report.lose(counts.dropped, "values with unknown signals or impossible ranges");
    report.note(counts.ubx, "UBX frames");
    report.note(counts.rtcm, "RTCM 3 messages");
    if (delivered() > 0) report.notes.push_back(in_view(last_));
    report.note(satellites_.size(), "satellites with ephemerides");
    report.clock = epochs_.state();
  }

  EpochClock epochs_;
  ppp::ReceiverStream stream_;
  ppp::Epoch epoch_, last_;
  std::set<ppp::Satellite> satellites_;  // satellites with an ephemeris
};

class LiveCorrections final : public sensors::StreamSource<GnssCorrections> {
 public:
  LiveCorrections(std::unique_ptr<sensors::ByteStream> caster, const sensors::HostClock& clock)
      : StreamSource(std::move(caster), clock), stream_(ppp::from_utc(clock.now())) {}

 private:
  bool take(std::span<const std::uint8_t>& bytes, Time arrival, GnssCorrections& sample) override {
    if (bytes.empty()) return false;
    stream_.set_now(ppp::from_utc(arrival));
    if (!stream_.push(std::exchange(bytes, {}))) return false;
    deliver(arrival, arrival, sample);
    sample.heard.take(stream_.navigation());
    std::swap(sample.updates, stream_.updates());
    stream_.updates().clear();
    sample.ionosphere = std::exchange(stream_.ionosphere(), std::nullopt);
    for (const ppp::SsrUpdate& u : sample.updates)
      if (u.clock) corrected_.insert(u.satellite);
    return true;
  }

  void restart() override { stream_.restart(); }

  void describe(sensors::LiveReport& report) const override {
    const ppp::CorrectionStreamCounts& counts = stream_.counts();
    report.refuse(counts.damaged, "frames with a wrong checksum, or incomplete");
    report.refuse(counts.unusable, "messages with inconsistent content");
    report.note(counts.messages, "RTCM 3 messages");
    report.note(counts.ephemerides, "ephemerides");
    report.note(counts.corrections, "messages of corrections");
    report.note(counts.unsupported, "unused messages of corrections");
    report.note(corrected_.size(), "satellites with corrected clocks");
  }

  ppp::CorrectionStream stream_;
  std::set<ppp::Satellite> corrected_;
};

}  // namespace

std::unique_ptr<sensors::LiveSource<GnssFix>> listen_to_fixes(
    std::unique_ptr<sensors::ByteStream> receiver, Duration latency,
    const sensors::HostClock& clock) {
  return std::make_unique<LiveFixes>(std::move(receiver), latency, clock);
}

std::unique_ptr<sensors::LiveSource<GnssEpoch>> listen_to_receiver(
    std::unique_ptr<sensors::ByteStream> receiver, Duration latency,
    const sensors::HostClock& clock) {
  return std::make_unique<LiveReceiver>(std::move(receiver), latency, clock);
}

std::unique_ptr<sensors::LiveSource<GnssCorrections>> listen_to_corrections(
    std::unique_ptr<sensors::ByteStream> caster, const sensors::HostClock& clock) {
  return std::make_unique<LiveCorrections>(std::move(caster), clock);
}

}  // namespace maploop::vehicle
