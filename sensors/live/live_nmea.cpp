#include <algorithm>
#include <utility>

#include "sensors/live/line_connection.h"
#include "sensors/live/live_sensors.h"

namespace maploop::sensors {
namespace {

class LiveNmea final : public LiveSource<GnssFix> {
 public:
  LiveNmea(Endpoint endpoint, const NmeaParameters& parameters, const HostClock& clock)
      : lines_(std::move(endpoint), clock), fixes_(parameters) {}

  bool wait(GnssFix& fix, Duration patience) override {
    return lines_.wait(patience, [&](std::string_view line, Time arrival) {
      if (!fixes_.add(line, arrival, fix)) return false;
      // Several lines may arrive at once.
      fix.available = last_available_ = std::max(fix.available, last_available_ + Duration(1));
      ++delivered_;
      return true;
    });
  }

  LiveReport report() const override {
    const NmeaCounts& counts = fixes_.counts();
    LiveReport report{lines_.endpoint().text,
                      lines_.state(),
                      delivered_,
                      counts.damaged + lines_.dropped() + counts.repeated,
                      {},
                      {},
                      {}};
    note_count(report.reasons, counts.damaged, "lines without a right checksum");
    note_count(report.reasons, lines_.dropped(), "lines too long");
    note_count(report.reasons, counts.repeated, "epochs not later than the one before");
    note_count(report.reasons, counts.no_fix, "epochs without a fix");
    note_count(report.notes, counts.sentences, "sentences");
    const ClockOffset& offset = fixes_.clock();
    report.clock = {offset.known(), fixes_.utc_offset(), offset.drift(), offset.delay(),
                    fixes_.jumps()};
    return report;
  }

 private:
  LineConnection lines_;
  NmeaFixes fixes_;
  std::uint64_t delivered_ = 0;
  Time last_available_{};
};

}  // namespace

std::unique_ptr<LiveSource<GnssFix>> listen_to_nmea(Endpoint endpoint,
                                                    const NmeaParameters& parameters,
                                                    const HostClock& clock) {
  return std::make_unique<LiveNmea>(std::move(endpoint), parameters, clock);
}

}  // namespace maploop::sensors
