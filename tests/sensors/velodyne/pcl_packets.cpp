#include "tests/sensors/velodyne/pcl_packets.h"

#include <pcl/io/hdl_grabber.h>
#include <pcl/io/vlp_grabber.h>

#include <functional>
#include <string>
#include <utility>

namespace maploop::sensors {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZI>;

void decode_packet(pcl::HDLGrabber& grabber, void* packet);

// PCL decodes packets only on its own threads and sockets; the function that does it is private,
// but an explicit instantiation may name it.
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

// Gives access to the points of the current turn.
template <class Base>
struct Watched final : Base {
  using Base::Base;
  const Cloud& turn() const { return *this->current_sweep_xyzi_; }
};

}  // namespace

struct PclPackets::Grabber {
  template <class Base, class... Arguments>
  static std::unique_ptr<Grabber> make(Arguments... arguments) {
    auto watched = std::make_unique<Watched<Base>>(arguments...);
    auto grabber = std::make_unique<Grabber>();
    grabber->turn = [w = watched.get()]() -> const Cloud& { return w->turn(); };
    grabber->pcl = std::move(watched);
    const std::function<void(const Cloud::ConstPtr&)> sweep =
        [g = grabber.get()](const Cloud::ConstPtr& cloud) { g->done.push_back(cloud); };
    grabber->pcl->registerCallback(sweep);
    // Otherwise PCL makes points of missing returns.
    float nearest = 1e-3F;  // m
    grabber->pcl->setMinimumDistanceThreshold(nearest);
    return grabber;
  }

  std::function<const Cloud&()> turn;
  std::unique_ptr<pcl::HDLGrabber> pcl;
  std::vector<Cloud::ConstPtr> done;  // turns that ended in the current packet
};

PclPackets::PclPackets(std::unique_ptr<Grabber> grabber) : grabber_(std::move(grabber)) {}
PclPackets::~PclPackets() = default;
PclPackets::PclPackets(PclPackets&&) noexcept = default;

PclPackets PclPackets::vlp16() {
  return PclPackets(Grabber::make<pcl::VLPGrabber>(std::string()));
}
PclPackets PclPackets::hdl32e() {
  return PclPackets(Grabber::make<pcl::HDLGrabber>(std::string(), std::string()));
}
PclPackets PclPackets::hdl64e(const std::filesystem::path& calibration) {
  return PclPackets(Grabber::make<pcl::HDLGrabber>(calibration.string(), std::string()));
}

std::vector<LidarPoint> PclPackets::decode(std::span<const std::uint8_t> packet) {
  std::vector<std::uint8_t> bytes(packet.begin(), packet.end());
  std::vector<LidarPoint> points;
  std::size_t seen = grabber_->turn().size();
  const auto take = [&](const Cloud& cloud) {
    for (std::size_t i = seen; i < cloud.size(); ++i) {
      const pcl::PointXYZI& p = cloud[i];
      points.push_back({p.y, -p.x, p.z, p.intensity});
    }
    seen = 0;
  };
  grabber_->done.clear();
  decode_packet(*grabber_->pcl, bytes.data());
  for (const Cloud::ConstPtr& cloud : grabber_->done) take(*cloud);
  take(grabber_->turn());
  return points;
}

}  // namespace maploop::sensors
