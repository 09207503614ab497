// Defines the faults that can be injected into a replay, and the text in which a user writes one:
//
//   KIND@TARGET[:START[:LENGTH]][,key=value...]
//
// fault_rules.h has every kind with its targets, and the default, unit and bound of `by`; FAULTS.md
// shows them.
//
// START and LENGTH are seconds of data time, and LENGTH may be `end`; without them the fault lasts
// all the time. START counts from the drive's first image, and 0 means from the very first sample
// on. These are the other keys with their defaults:
//   share    share of the samples that are struck, above 0 up to 1, drawn by `seed` and stamp: 1
//   seed     whole number from 0: 1
//   threads  1 to 16: 2
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "msgs/time.h"

namespace maploop::vehicle {

enum class FaultKind : std::uint8_t {
  late,
  lost,
  duplicated,
  reordered,
  jump,
  nan,
  frozen,
  black,
  garbage,
  bias,
  drift,
  scale,
  noise,
  spoofed,
  bumped,
  skewed,
  blurred,
  dimmed,
  blocked,
  rain,
  slow,
  broken,
  hog,
};

enum class FaultTarget : std::uint8_t {
  camera,
  velodyne,
  imu,
  gyro,           // of the imu
  accelerometer,  // of the imu
  gnss,
  wheel,
  stereo,
  lidar,
  ppp,
  fusion,
  mapmatch,
  cpu
};

// "camera"; the name of the stage where the target is one.
std::string_view target_name(FaultTarget target);

struct Fault {
  std::string text;  // as the user wrote it
  FaultKind kind = FaultKind::lost;
  FaultTarget target = FaultTarget::camera;
  Duration start{};                // from the drive's first image; 0: from the first sample on
  std::optional<Duration> length;  // nullopt: to the end
  double by = 0.0;                 // in the unit of its rule
  double share = 1.0;
  std::uint64_t seed = 1;
  int threads = 0;
};

// A hog ends after this time at the latest, so that the machine is soon usable again.
inline constexpr Duration longest_hog = std::chrono::seconds(60);

// Throws std::invalid_argument naming the text, what is wrong with it, and what would be allowed.
Fault parse_fault(std::string_view text);

// A FaultWindow is the period of data time in which a fault is active.
struct FaultWindow {
  Time begin = Time::min();
  Time end = Time::max();

  bool contains(Time t) const { return begin <= t && t < end; }
};

// Returns the window of `fault`; `origin` is the stamp of the drive's first image.
FaultWindow window(const Fault& fault, Time origin);

}  // namespace maploop::vehicle
