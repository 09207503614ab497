#include "runtime/vehicle/drivers/live_fixes.h"

#include <string>
#include <utility>

#include "ppp/readers/streams/pvt_stream.h"
#include "runtime/vehicle/drivers/epoch_stamps.h"
#include "runtime/vehicle/drivers/stream_reader.h"

namespace maploop::vehicle {
namespace {

class LiveFixes final : public sensors::LiveSource<GnssFix> {
 public:
  LiveFixes(std::unique_ptr<sensors::ByteStream> receiver, Duration latency,
            const sensors::HostClock& clock)
      : reader_(std::move(receiver), clock), stamps_(latency) {}

  bool wait(GnssFix& fix, Duration patience) override {
    const bool came = reader_.wait(patience, stream_, [this] { return next_fix(); });
    if (came) deliver(fix);
    return came;
  }

  sensors::LiveReport report() const override {
    const ppp::PvtStreamCounts& counts = stream_.counts();
    const sensors::ByteStream& receiver = reader_.stream();
    sensors::LiveReport report{receiver.name(),
                               receiver.state(),
                               delivered_,
                               counts.damaged + counts.unusable + counts.repeated,
                               {},
                               {},
                               stamps_.clock()};
    sensors::note_count(report.reasons, receiver.state().too_large, "datagrams too long");
    sensors::note_count(report.reasons, counts.damaged,
                        "frames with a wrong checksum, or incomplete");
    sensors::note_count(report.reasons, counts.unusable, "NAV-PVT with inconsistent content");
    sensors::note_count(report.reasons, counts.repeated, "epochs not later than the one before");
    sensors::note_count(report.reasons, no_fix_, "epochs without a fix");
    sensors::note_count(report.notes, counts.frames, "UBX frames");
    if (delivered_ > 0)
      report.notes.push_back("last fix: " + std::to_string(satellites_) + " satellites");
    return report;
  }

 private:
  bool next_fix() {
    while (stream_.next(pvt_)) {
      if (pvt_.fix) return true;
      ++no_fix_;
    }
    return false;
  }

  void deliver(GnssFix& fix) {
    stamps_.stamp(pvt_.time, reader_.arrival(), fix);
    fix.sequence = delivered_++;
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

  StreamReader reader_;
  EpochStamps stamps_;
  ppp::PvtStream stream_;
  ppp::UbxPvt pvt_;
  int satellites_ = 0;  // in the last fix
  std::uint64_t delivered_ = 0, no_fix_ = 0;
};

}  // namespace

std::unique_ptr<sensors::LiveSource<GnssFix>> listen_to_fixes(
    std::unique_ptr<sensors::ByteStream> receiver, Duration latency,
    const sensors::HostClock& clock) {
  return std::make_unique<LiveFixes>(std::move(receiver), latency, clock);
}

}  // namespace maploop::vehicle
