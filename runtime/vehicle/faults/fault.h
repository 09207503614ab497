// Defines the faults that can be injected into a replay, and the text in which a user writes one:
//
//   KIND@TARGET[:START[:LENGTH]][,key=value...]
//
//   late        camera velodyne imu gnss   a sample arrives `by` later; none overtakes it
//   lost        camera velodyne imu gnss   a sample never arrives
//   duplicated  camera velodyne imu gnss   a sample arrives again, `by` later
//   reordered   camera velodyne imu gnss   a sample arrives after its successor
//   jump        camera velodyne imu gnss   the stamps are wrong by `by`; the arrival is unchanged
//   nan         velodyne imu gnss          every number of a sample is NaN
//   frozen      imu gnss                   a sample's numbers are those of the first one struck
//   black       camera                     both images are black
//   garbage     camera                     both images are noise
//   slow        stereo lidar ppp fusion mapmatch   the stage sleeps `by` at each image, scan, ...
//   broken      stereo lidar ppp fusion mapmatch   the stage ends with an error
//   hog         cpu                        `threads` threads are busy for LENGTH (required)
//
// START and LENGTH are seconds of data time, and LENGTH may be `end`; without them the fault lasts
// all the time. START counts from the drive's first image, and 0 means from the very first sample
// on. These are the keys with their defaults:
//   by       s. late 0.2 (up to 10), duplicated 0.001 (up to 1), slow 0.1 (up to 1), jump 1 (up to
//            1e6, either sign); never 0
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
  slow,
  broken,
  hog,
};

enum class FaultTarget : std::uint8_t {
  camera,
  velodyne,
  imu,
  gnss,
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
  Duration by{};
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
