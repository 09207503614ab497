#include <utility>

#include "sensors/live/line_splitter.h"
#include "sensors/live/live_sensors.h"
#include "sensors/live/stream_source.h"

namespace maploop::sensors {
namespace {

class LiveNmea final : public StreamSource<GnssFix> {
 public:
  LiveNmea(Endpoint endpoint, const NmeaParameters& parameters, const HostClock& clock)
      : StreamSource(std::make_unique<Connection>(std::move(endpoint)), clock),
        fixes_(parameters) {}

 private:
  bool take(std::span<const std::uint8_t>& bytes, Time arrival, GnssFix& fix) override {
    for (std::string_view line; lines_.next(bytes, line);) {
      if (!fixes_.add(line, arrival, fix)) continue;
      deliver(fix.stamp, arrival, fix);
      return true;
    }
    return false;
  }
  void restart() override { lines_.restart(); }
  void describe(LiveReport& report) const override {
    const NmeaCounts& counts = fixes_.counts();
    report.refuse(counts.damaged, "lines without a right checksum");
    report.refuse(lines_.dropped(), "lines too long");
    report.refuse(counts.repeated, "epochs not later than the one before");
    report.lose(counts.no_fix, "epochs without a fix");
    report.note(counts.sentences, "sentences");
    report.clock = fixes_.clock().state(fixes_.utc_offset());
  }

  LineSplitter lines_;
  NmeaFixes fixes_;
};

}  // namespace

std::unique_ptr<LiveSource<GnssFix>> listen_to_nmea(Endpoint endpoint,
                                                    const NmeaParameters& parameters,
                                                    const HostClock& clock) {
  return std::make_unique<LiveNmea>(std::move(endpoint), parameters, clock);
}

}  // namespace maploop::sensors
