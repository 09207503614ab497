#include <algorithm>
#include <array>
#include <utility>

#include "sensors/live/line_splitter.h"
#include "sensors/live/live_sensors.h"

namespace maploop::sensors {
namespace {

class LiveNmea final : public LiveSource<GnssFix> {
 public:
  LiveNmea(Endpoint endpoint, const NmeaParameters& parameters, const HostClock& clock)
      : clock_(clock), connection_(std::move(endpoint)), fixes_(parameters) {}

  bool wait(GnssFix& fix, Duration patience) override {
    const Time end = clock_.now() + patience;
    do {
      if (unread_.empty()) {
        const std::uint64_t opened = connection_.state().opened;
        const std::size_t size = connection_.read(buffer_, end - clock_.now());
        if (connection_.state().opened != opened) lines_.restart();
        if (size == 0) return false;
        unread_ = std::span(buffer_).first(size);
        arrival_ = clock_.now();
      }
      for (std::string_view line; lines_.next(unread_, line);) {
        if (fixes_.add(line, arrival_, fix)) {
          // Several may come at once.
          fix.available = last_available_ = std::max(fix.available, last_available_ + Duration(1));
          ++delivered_;
          return true;
        }
      }
    } while (clock_.now() < end);
    return false;
  }

  LiveReport report() const override {
    const NmeaCounts& counts = fixes_.counts();
    LiveReport report{connection_.endpoint().text,
                      connection_.state(),
                      delivered_,
                      counts.damaged + lines_.dropped() + counts.repeated,
                      {},
                      {}};
    note_count(report.reasons, counts.damaged, "lines without a right checksum");
    note_count(report.reasons, lines_.dropped(), "lines too long");
    note_count(report.reasons, counts.repeated, "epochs not later than the one before");
    note_count(report.reasons, counts.no_fix, "epochs without a fix");
    note_count(report.notes, counts.sentences, "sentences");
    if (const auto offset = fixes_.utc_offset()) {
      report.notes.push_back("its UTC is " + std::to_string(to_seconds(*offset)) +
                             " s ahead of the host's clock");
    }
    return report;
  }

 private:
  const HostClock& clock_;
  Connection connection_;
  NmeaFixes fixes_;
  LineSplitter lines_;
  std::array<std::uint8_t, 1024> buffer_{};
  std::span<const std::uint8_t> unread_;
  Time arrival_{};
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
