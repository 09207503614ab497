// LCM logs replayed: every sensor to its end, by increasing times that do not leap.
#include <stdexcept>

#include "msgs/input_limits.h"
#include "msgs/lcm/channel_names.h"
#include "sensors/replay/log_recording.h"
#include "tests/fuzz/fuzz_input.h"

using namespace maploop;

namespace {

template <class T>
void read(std::unique_ptr<sensors::Source<T>> source) {
  if (source == nullptr) return;
  Time last = Time::min();
  for (T sample; source->next(sample); last = sample.available) {
    fuzz::require(last == Time::min() ||
                  (sample.available > last &&
                   input_limits::within(input_limits::longest_pause, last, sample.available)));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::MemoryFile file(data, size);
  try {
    const sensors::LogRecording recording(file.path());
    read(recording.source<StereoPair>(channel_names::camera));
    read(recording.source<LidarScan>(channel_names::velodyne));
    read(recording.source<ImuSample>(channel_names::imu));
    read(recording.source<GnssFix>(channel_names::gnss_fix));
    read(recording.source<WheelSpeed>(channel_names::wheel_speed));
    read(recording.source<ReferencePose>(channel_names::truth));
    read(recording.source<RelativeMotion>(channel_names::odometry));
    read(recording.source<LidarMotion>(channel_names::lidar_odometry));
  } catch (const std::runtime_error&) {
  }
  return 0;
}
