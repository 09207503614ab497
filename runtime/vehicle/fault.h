// Faults that a replay can be asked for, and how a user writes one down.
//
//   KIND@TARGET[:START[:LENGTH]][,key=value...]
//
//   late        camera velodyne imu gnss   arrives `by` later; what follows does not overtake it
//   lost        camera velodyne imu gnss   never arrives
//   duplicated  camera velodyne imu gnss   arrives again, `by` later
//   reordered   camera velodyne imu gnss   arrives behind its successor
//   jump        camera velodyne imu gnss   its stamps are wrong by `by`; it arrives as before
//   nan         velodyne imu gnss          every number of it is NaN
//   frozen      imu gnss                   its numbers are those of the first sample that is struck
//   black       camera                     both images are black
//   garbage     camera                     both images are noise
//   slow        stereo lidar ppp fusion mapmatch   the stage sleeps `by` at each image, scan, ...
//   broken      stereo lidar ppp fusion mapmatch   the stage ends with an error
//   hog         cpu                        `threads` busy threads for LENGTH, which must be given
//
// START and LENGTH are seconds of data time, LENGTH may be `end`; without them the fault is there
// all the time. START counts from the drive's first image, and 0 means from the very first sample
// on. Keys:
//   by       s. late 0.2 (up to 10), duplicated 0.001 (up to 1), jump 1 (up to 1e6, either sign,
//   not 0),
//            slow 0.1 (up to 1)
//   share    of the samples that are struck, above 0 and up to 1, drawn by `seed` and stamp: 1
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

struct Fault {
  std::string text;  // as its user wrote it
  FaultKind kind = FaultKind::lost;
  FaultTarget target = FaultTarget::camera;
  Duration start{};                // from the drive's first image; 0: from the first sample on
  std::optional<Duration> length;  // nothing: to the end
  Duration by{};
  double share = 1.0;
  std::uint64_t seed = 1;
  int threads = 0;
};

// A busy machine is a fault for a while, and must not outlive the patience of who waits for it.
inline constexpr Duration longest_hog = std::chrono::seconds(60);

// Throws std::invalid_argument naming the text, what is wrong with it, and what would be allowed.
Fault parse_fault(std::string_view text);

// When a fault is there.
struct FaultWindow {
  Time begin = Time::min();
  Time end = Time::max();

  bool contains(Time t) const { return begin <= t && t < end; }
};

// `origin`: stamp of the drive's first image.
FaultWindow window(const Fault& fault, Time origin);

}  // namespace maploop::vehicle
