#include "tests/sensors/velodyne/pcl_packets.h"

#include <pcl/io/hdl_grabber.h>
#include <pcl/io/vlp_grabber.h>

#include <utility>

namespace maploop::sensors {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZI>;

void decode_packet(pcl::HDLGrabber& grabber, void* packet);

// PCL decodes packets on threads and sockets of its own alone; the function that does it is
// private, which an explicit instantiation may name.
template <auto member>
struct Opened {
  template <class Packet>
  static void call(pcl::HDLGrabber& grabber, void (pcl::HDLGrabber::*function)(Packet*),
                   void* packet) {
    (grabber.*function)(static_cast<Packet*>(packet));
  }
  friend void decode_packet(pcl::HDLGrabber& grabber, void* packet) {
    call(grabber, member, packet);
  }
};
template struct Opened<&pcl::HDLGrabber::toPointClouds>;

}  // namespace

struct PclPackets::Grabber {
  explicit Grabber(std::unique_ptr<pcl::HDLGrabber> made) : pcl(std::move(made)) {
    const std::function<void(const Cloud::ConstPtr&)> sweep = [this](const Cloud::ConstPtr& cloud) {
      done.push_back(cloud);
    };
    pcl->registerCallback(sweep);
    const std::function<void(const Cloud::ConstPtr&, float, float)> scan =
        [this](const Cloud::ConstPtr& cloud, float, float) { packet = cloud; };
    pcl->registerCallback(scan);
  }

  std::unique_ptr<pcl::HDLGrabber> pcl;
  std::vector<Cloud::ConstPtr> done;
  Cloud::ConstPtr packet;
};

PclPackets::PclPackets(std::unique_ptr<Grabber> grabber) : grabber_(std::move(grabber)) {}
PclPackets::~PclPackets() = default;
PclPackets::PclPackets(PclPackets&&) noexcept = default;

PclPackets PclPackets::vlp16() {
  return PclPackets(std::make_unique<Grabber>(std::make_unique<pcl::VLPGrabber>("")));
}
PclPackets PclPackets::hdl32e() {
  return PclPackets(std::make_unique<Grabber>(std::make_unique<pcl::HDLGrabber>("", "")));
}
PclPackets PclPackets::hdl64e(const std::filesystem::path& calibration) {
  return PclPackets(
      std::make_unique<Grabber>(std::make_unique<pcl::HDLGrabber>(calibration.string(), "")));
}

std::vector<LidarPoint> PclPackets::decode(std::span<const std::uint8_t> packet) {
  std::vector<std::uint8_t> bytes(packet.begin(), packet.end());
  grabber_->packet.reset();
  decode_packet(*grabber_->pcl, bytes.data());
  std::vector<LidarPoint> points;
  if (grabber_->packet == nullptr) return points;
  for (const pcl::PointXYZI& p : *grabber_->packet) points.push_back({p.y, -p.x, p.z, p.intensity});
  return points;
}

}  // namespace maploop::sensors
