// The vehicle's graph in one table: what runs when, when its result becomes available, by when it has
// to be done, and which ring joins whom.
#pragma once

#include <cstddef>
#include <string_view>

#include "msgs/time.h"

namespace maploop::vehicle {

using std::chrono::milliseconds;

struct Stage {
  std::string_view name;
  Duration period;    // of data time; 0: released by its input
  Duration budget;    // the result becomes available this long after the release, in data time
  Duration deadline;  // from release to result, on the machine's clock; 0: none
};

namespace stages {
inline constexpr Stage camera{"camera", {}, {}, {}};
inline constexpr Stage velodyne{"velodyne", {}, {}, {}};
inline constexpr Stage imu{"imu", {}, {}, {}};
inline constexpr Stage gnss{"gnss", {}, {}, {}};
inline constexpr Stage reference{"reference", {}, {}, {}};
inline constexpr Stage stereo{"stereo", {}, milliseconds(50), milliseconds(50)};
inline constexpr Stage fusion{"fusion", milliseconds(10), milliseconds(1), milliseconds(2)};
inline constexpr Stage publisher{"publisher", {}, {}, {}};
inline constexpr Stage health{"health", std::chrono::seconds(1), {}, {}};
}  // namespace stages

// Capacities in samples: small where samples are large, seconds of data where they are small.
namespace capacity {
inline constexpr std::size_t images = 4;
inline constexpr std::size_t samples = 256;
inline constexpr std::size_t states = 1024;
inline constexpr std::size_t reports = 8;
}  // namespace capacity

namespace channels {
inline constexpr std::string_view nav_state = "NAV_STATE";
inline constexpr std::string_view visual_odometry = "VO";
inline constexpr std::string_view imu = "IMU";
inline constexpr std::string_view gnss_fix = "GNSS_FIX";
inline constexpr std::string_view truth = "TRUTH";
inline constexpr std::string_view deadlines = "DEADLINES";
inline constexpr std::string_view health = "HEALTH";
}  // namespace channels

}  // namespace maploop::vehicle
