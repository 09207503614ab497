#include "runtime/vehicle/drivers/live_corrections.h"

#include <algorithm>
#include <array>
#include <set>
#include <span>
#include <utility>

#include "ppp/readers/corrections/correction_stream.h"

namespace maploop::vehicle {
namespace {

class LiveCorrections final : public sensors::LiveSource<GnssCorrections> {
 public:
  LiveCorrections(std::unique_ptr<sensors::ByteStream> caster, const sensors::HostClock& clock)
      : clock_(clock), caster_(std::move(caster)), stream_(ppp::from_utc(clock.now())) {}

  bool wait(GnssCorrections& sample, Duration patience) override {
    const Time end = clock_.now() + patience;
    do {
      const std::uint64_t opened = caster_->state().opened;
      const std::size_t size = caster_->read(buffer_, end - clock_.now());
      if (caster_->state().opened != opened) stream_.restart();
      if (size == 0) return false;
      const Time arrival = clock_.now();
      stream_.set_now(ppp::from_utc(arrival));
      if (stream_.push(std::span(buffer_).first(size))) {
        deliver(sample, arrival);
        return true;
      }
    } while (clock_.now() < end);
    return false;
  }

  sensors::LiveReport report() const override {
    const ppp::CorrectionStreamCounts& counts = stream_.counts();
    sensors::LiveReport report{caster_->name(),
                               caster_->state(),
                               delivered_,
                               counts.damaged + counts.unusable,
                               {},
                               {},
                               {}};
    sensors::note_count(report.reasons, caster_->state().too_large, "datagrams too long");
    sensors::note_count(report.reasons, counts.damaged,
                        "frames with a wrong checksum, or incomplete");
    sensors::note_count(report.reasons, counts.unusable, "messages with inconsistent content");
    sensors::note_count(report.notes, counts.messages, "RTCM 3 messages");
    sensors::note_count(report.notes, counts.ephemerides, "ephemerides");
    sensors::note_count(report.notes, counts.corrections, "messages of corrections");
    sensors::note_count(report.notes, counts.unsupported, "unused messages of corrections");
    sensors::note_count(report.notes, corrected_.size(), "satellites with corrected clocks");
    return report;
  }

 private:
  void deliver(GnssCorrections& sample, Time arrival) {
    sample.stamp = sample.available = last_ = std::max(arrival, last_ + Duration(1));
    sample.sequence = delivered_++;
    sample.heard.take(stream_.navigation());
    std::swap(sample.updates, stream_.updates());
    stream_.updates().clear();
    for (const ppp::SsrUpdate& u : sample.updates)
      if (u.clock) corrected_.insert(u.satellite);
  }

  const sensors::HostClock& clock_;
  std::unique_ptr<sensors::ByteStream> caster_;
  ppp::CorrectionStream stream_;
  std::array<std::uint8_t, 2048> buffer_{};
  std::set<ppp::Satellite> corrected_;
  std::uint64_t delivered_ = 0;
  Time last_{};
};

}  // namespace

std::unique_ptr<sensors::LiveSource<GnssCorrections>> listen_to_corrections(
    std::unique_ptr<sensors::ByteStream> caster, const sensors::HostClock& clock) {
  return std::make_unique<LiveCorrections>(std::move(caster), clock);
}

}  // namespace maploop::vehicle
