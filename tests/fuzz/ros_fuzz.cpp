// Messages of ROS, and what is made of them: the first byte chooses type and encoding.
#include <cmath>
#include <stdexcept>
#include <vector>

#include "sensors/bag/camera_messages.h"
#include "sensors/bag/cloud_scans.h"
#include "sensors/bag/ros_messages.h"
#include "tests/fuzz/fuzz_input.h"

using namespace maploop;
using namespace maploop::sensors;

namespace {

using Bytes = std::span<const std::uint8_t>;

template <class T>
T decoded(const char* encoding, Bytes message) {
  T to;
  decode({"/topic", "", encoding, ""}, message, to);
  return to;
}

void use_cloud(const RosPointCloud& message) {
  TimedCloud cloud;
  read_cloud(message, cloud);
  fuzz::require(!cloud.points.empty());
  fuzz::require(cloud.times.empty() || cloud.times.size() == cloud.points.size());
  if (cloud.times.empty()) return;
  CloudScans scans(std::chrono::milliseconds(250));
  scans.add(cloud);
  for (LidarScan scan; scans.next(scan) || scans.end();) {
    fuzz::require(scan.start <= scan.end);
    fuzz::require(scan.times.empty() || scan.times.size() == scan.points.size());
  }
}

template <class T>
void use_image(const T& message) {
  GreyImage grey;
  to_grey(message, grey);
  fuzz::require(grey.pixels.size() ==
                static_cast<std::size_t>(grey.width) * static_cast<std::size_t>(grey.height));
}

void use_cameras(const RosCameraInfo& info) {
  RosCameraInfo right = info;
  right.p[3] -= right.p[0];
  for (const bool rectified : {false, true})
    fuzz::require(stereo_of(info, right, rectified).rectified.baseline > 0.0);
}

void use(unsigned type, const char* encoding, Bytes message) {
  switch (type) {
    case 0:
      return use_image(decoded<RosImage>(encoding, message));
    case 1:
      return use_image(decoded<RosCompressedImage>(encoding, message));
    case 2:
      return use_cameras(decoded<RosCameraInfo>(encoding, message));
    case 3:
      return use_cloud(decoded<RosPointCloud>(encoding, message));
    case 4:
      decoded<RosImu>(encoding, message);
      return;
    case 5:
      decoded<RosFix>(encoding, message);
      return;
    case 6:
      decoded<RosTwist>(encoding, message);
      return;
    case 7:
      for (const RosVelodynePacket& packet : decoded<RosVelodyneScan>(encoding, message).packets)
        fuzz::require(!packet.data.empty());
      return;
    default:
      for (const RosTransform& t : decoded<RosTransforms>(encoding, message).transforms)
        fuzz::require(t.T_parent_child.matrix().allFinite());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  try {
    use(data[0] % 16U, data[0] & 16U ? "ros1" : "cdr", {data + 1, size - 1});
  } catch (const std::invalid_argument&) {
  } catch (const std::runtime_error&) {  // of an image's file
  }
  return 0;
}
