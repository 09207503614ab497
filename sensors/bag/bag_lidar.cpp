#include <algorithm>

#include "sensors/bag/cloud_scans.h"
#include "sensors/bag/topic_stream.h"
#include "sensors/velodyne/data_packet.h"
#include "sensors/velodyne/velodyne_decoder.h"

namespace maploop::sensors {
namespace {

class ScanMaker {
 public:
  ScanMaker(SharedBagSettings settings, const Topic& lidar, Time passed)
      : stream_(std::move(settings), {lidar.name}),
        topic_(lidar),
        passed_(passed),
        scans_(from_seconds(stream_.settings().limits.max_turn)) {}

  bool next(LidarScan& scan, SourceReport& report) {
    while (true) {
      if (scans_.next(scan)) {
        if (stream_.follows(topic_, scan, report)) return true;
        continue;
      }
      const RecordedMessage* message = stream_.next(report);
      if (message == nullptr && !scans_.end()) return false;
      if (message != nullptr && read(*message, scan, report)) return true;
    }
  }

 private:
  // Returns whether the message is a scan without times.
  bool read(const RecordedMessage& message, LidarScan& scan, SourceReport& report) {
    if (!stream_.decoded(message, cloud_message_, report)) return false;
    const BagSettings& s = stream_.settings();
    cloud_message_.header.stamp = stream_.stamp(cloud_message_.header, message);
    try {
      read_cloud(cloud_message_, cloud_);
    } catch (const std::invalid_argument& e) {
      stream_.refuse(topic_, e.what(), report);
      return false;
    }
    if (cloud_.dropped > 0) {
      report.flaw({s.path.string(), 0,
                   topic_.name + ", message " + std::to_string(stream_.number()) + ": " +
                       std::to_string(cloud_.dropped) + " points are not finite and were dropped"});
    }
    if (!cloud_.times.empty()) {
      scans_.add(cloud_);
      return false;
    }
    set_stamps(cloud_message_.header.stamp, s, scan);
    scan.sequence = stream_.number() - 1;
    scan.times.clear();
    if (!stream_.follows(topic_, scan, report)) return false;
    if (scan.available > passed_) std::swap(scan.points, cloud_.points);
    return true;
  }

  static void set_stamps(Time stamp, const BagSettings& s, LidarScan& scan) {
    const Duration half = s.turn / 2;
    const Duration to_middle = s.parameters.cloud_stamp == CloudStamp::start ? half
                               : s.parameters.cloud_stamp == CloudStamp::end ? -half
                                                                             : Duration{};
    scan.stamp = stamp + to_middle;
    scan.start = scan.stamp - half;
    scan.end = scan.available = scan.stamp + half;
  }

  TopicStream stream_;
  Topic topic_;
  Time passed_;
  RosPointCloud cloud_message_;
  TimedCloud cloud_;
  CloudScans scans_;
};

// Decodes the packets of a Velodyne scanner, whose model the first of them states.
class PacketScanMaker {
 public:
  PacketScanMaker(SharedBagSettings settings, const Topic& lidar)
      : stream_(std::move(settings), {lidar.name}), topic_(lidar) {}

  bool next(LidarScan& scan, SourceReport& report) {
    while (true) {
      while (at_ < message_.packets.size()) {
        const bool ended = take(message_.packets[at_++], scan, report);
        if (ended && stream_.follows(topic_, scan, report)) return true;
      }
      const RecordedMessage* message = stream_.next(report);
      at_ = 0;
      message_.packets.clear();
      if (message == nullptr) return end(report);
      if (!stream_.decoded(*message, message_, report)) message_.packets.clear();
      received_ = message->received;
    }
  }

 private:
  // Returns whether the packet ended a turn.
  bool take(const RosVelodynePacket& packet, LidarScan& scan, SourceReport& report) {
    if (!decoder_ && !begin(packet, report)) return false;
    const BagSettings& s = stream_.settings();
    last_ = std::max(last_, s.header_stamps ? packet.stamp : received_);
    return decoder_->add(packet.data, last_, scan);
  }

  bool begin(const RosVelodynePacket& packet, SourceReport& report) {
    if (refused_) return false;
    PacketFault fault{};
    const DataPacket first = DataPacket::check(packet.data, fault);
    const auto model = fault == PacketFault::none ? first.model() : std::nullopt;
    if (!model) return false;
    const BagSettings& s = stream_.settings();
    try {
      decoder_.emplace(*model,
                       s.vehicle.lidar_calibration.empty()
                           ? factory_lasers(*model)
                           : read_velodyne_calibration(s.vehicle.lidar_calibration, *model),
                       from_seconds(s.limits.max_turn));
      return true;
    } catch (const std::exception& e) {
      refused_ = true;
      stream_.refuse(topic_, std::string(e.what()) + " ([vehicle.lidar] calibration)", report);
      return false;
    }
  }

  bool end(SourceReport& report) {
    if (!decoder_ && !refused_)
      stream_.refuse(topic_, "there is no data packet of a known Velodyne scanner", report);
    refused_ = true;
    return false;
  }

  TopicStream stream_;
  Topic topic_;
  RosVelodyneScan message_;
  std::size_t at_ = 0;
  Time received_{}, last_{};
  std::optional<VelodyneDecoder> decoder_;
  bool refused_ = false;
};

}  // namespace

std::unique_ptr<Source<LidarScan>> make_bag_lidar(SharedBagSettings settings, const Topic& lidar,
                                                  Time passed) {
  if (is_of<RosVelodyneScan>(lidar))
    return made_by<LidarScan>(PacketScanMaker(std::move(settings), lidar));
  return made_by<LidarScan>(ScanMaker(std::move(settings), lidar, passed));
}

}  // namespace maploop::sensors
