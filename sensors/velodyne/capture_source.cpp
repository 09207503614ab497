#include "sensors/velodyne/capture_source.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace maploop::sensors {
namespace {

std::vector<Laser> lasers_of(VelodyneModel model, const std::filesystem::path& calibration) {
  return calibration.empty() ? factory_lasers(model)
                             : read_velodyne_calibration(calibration, model);
}

}  // namespace

VelodyneCapture::Scanner VelodyneCapture::find(const std::filesystem::path& file,
                                               std::optional<VelodyneModel> model) {
  CaptureReader reader(file);
  for (CapturedPacket captured; reader.next(captured);) {
    PacketFault fault{};
    const DataPacket packet = DataPacket::check(captured.payload, fault);
    if (fault != PacketFault::none) continue;
    if (const auto found = model ? model : packet.model()) return {*found, captured.source};
  }
  throw std::runtime_error("the capture '" + file.string() +
                           "' has no data packet of a known Velodyne scanner" +
                           (reader.damage().empty() ? "" : " (" + reader.damage() + ")"));
}

VelodyneCapture::VelodyneCapture(const std::filesystem::path& file,
                                 const VelodyneCaptureOptions& options)
    : VelodyneCapture(file, options, find(file, options.model)) {}

VelodyneCapture::VelodyneCapture(const std::filesystem::path& file,
                                 const VelodyneCaptureOptions& options, Scanner scanner)
    : file_(file),
      model_(scanner.model),
      address_(scanner.address),
      decoder_(scanner.model, lasers_of(scanner.model, options.calibration)),
      reader_(file) {}

bool VelodyneCapture::next(LidarScan& scan) {
  for (CapturedPacket packet; reader_.next(packet);) {
    const bool sized = packet.payload.size() == velodyne_data_size ||
                       packet.payload.size() == velodyne_position_size;
    if (!sized || packet.source != address_) {
      ++others_;
      continue;
    }
    // The capturing host's clock may have been set back.
    last_ = std::max(last_, packet.time);
    if (first_ == Time{}) first_ = last_;
    if (!decoder_.add(packet.payload, last_, scan)) continue;
    if (scan.stamp <= last_stamp_ || scan.available <= last_available_) {
      report_.refuse({file_.string(), 0, "a turn is not later than the one before"});
      continue;
    }
    last_stamp_ = scan.stamp;
    last_available_ = scan.available;
    ++report_.delivered;
    return true;
  }
  end();
  return false;
}

void VelodyneCapture::end() {
  const TurnCounts& turns = decoder_.turns();
  while (report_.refused < turns.broken) {
    report_.refuse({file_.string(), 0, "a turn is broken by missing packets"});
  }
  if (!reader_.damage().empty()) report_.refuse({file_.string(), 0, reader_.damage()});
}

}  // namespace maploop::sensors
