#include "runtime/vehicle/drivers/live_receiver.h"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <utility>

#include "ppp/filter/measurement.h"
#include "ppp/readers/streams/receiver_stream.h"
#include "runtime/vehicle/drivers/epoch_stamps.h"
#include "runtime/vehicle/drivers/stream_reader.h"

namespace maploop::vehicle {
namespace {

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

class LiveReceiver final : public sensors::LiveSource<GnssEpoch> {
 public:
  LiveReceiver(std::unique_ptr<sensors::ByteStream> receiver, Duration latency,
               const sensors::HostClock& clock)
      : reader_(std::move(receiver), clock),
        stamps_(latency),
        stream_(ppp::from_utc(clock.now())) {}

  bool wait(GnssEpoch& sample, Duration patience) override {
    const bool came = reader_.wait(patience, stream_, [this] { return stream_.next(epoch_); });
    if (came) deliver(sample);
    return came;
  }

  sensors::LiveReport report() const override {
    const ppp::ReceiverStreamCounts counts = stream_.counts();
    sensors::LiveReport report{reader_.stream().name(),
                               reader_.stream().state(),
                               delivered_,
                               counts.damaged + counts.unusable + counts.repeated,
                               {},
                               {},
                               stamps_.clock()};
    sensors::note_count(report.reasons, reader_.stream().state().too_large, "datagrams too long");
    sensors::note_count(report.reasons, counts.damaged,
                        "frames with a wrong checksum, or incomplete");
    sensors::note_count(report.reasons, counts.unusable, "messages with inconsistent content");
    sensors::note_count(report.reasons, counts.repeated, "epochs not later than the one before");
    sensors::note_count(report.reasons, counts.dropped,
                        "values with unknown signals or impossible ranges");
    sensors::note_count(report.notes, counts.ubx, "UBX frames");
    sensors::note_count(report.notes, counts.rtcm, "RTCM 3 messages");
    if (delivered_ > 0) report.notes.push_back(in_view(last_));
    sensors::note_count(report.notes, satellites_.size(), "satellites with ephemerides");
    return report;
  }

 private:
  void deliver(GnssEpoch& sample) {
    stamps_.stamp(epoch_.time, reader_.arrival(), sample);
    sample.sequence = delivered_++;
    last_ = epoch_;
    std::swap(sample.epoch, epoch_);
    sample.heard.take(stream_.navigation());
    for (const auto& m : sample.heard.kepler) satellites_.insert(m.satellite);
    for (const auto& m : sample.heard.glonass) satellites_.insert(m.satellite);
  }

  StreamReader reader_;
  EpochStamps stamps_;
  ppp::ReceiverStream stream_;
  ppp::Epoch epoch_, last_;
  std::set<ppp::Satellite> satellites_;  // satellites with an ephemeris
  std::uint64_t delivered_ = 0;
};

}  // namespace

std::unique_ptr<sensors::LiveSource<GnssEpoch>> listen_to_receiver(
    std::unique_ptr<sensors::ByteStream> receiver, Duration latency,
    const sensors::HostClock& clock) {
  return std::make_unique<LiveReceiver>(std::move(receiver), latency, clock);
}

}  // namespace maploop::vehicle
