// A stream of NMEA sentences, and of inertial samples as such.
#include <cmath>
#include <cstdio>
#include <string>

#include "sensors/gnss/nmea_fixes.h"
#include "sensors/imu/imu_line.h"
#include "sensors/live/line_splitter.h"
#include "tests/fuzz/fuzz_input.h"

using namespace maploop;
using namespace maploop::sensors;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  NmeaFixes fixes;
  LineSplitter lines;
  GnssFix fix;
  Time arrival = parse_time("2026-03-01 10:00:00"), last = Time::min();
  const auto take = [&](std::string_view line) {
    arrival += std::chrono::milliseconds(70);
    if (const auto sample = parse_imu_line(line))
      fuzz::require(std::abs(sample->values.specific_force_up) <= 500.0 &&
                    std::abs(sample->values.yaw_rate) <= 100.0 &&
                    std::abs(sample->values.pitch_rate) <= 100.0);
    if (!fixes.add(line, arrival, fix)) return;
    fuzz::require(fix.stamp > last && fix.position_covariance.allFinite() &&
                  fix.velocity_enu.allFinite() && std::isfinite(fix.position.height));
    last = fix.stamp;
  };
  std::span<const std::uint8_t> bytes(data, size);
  for (std::string_view line; lines.next(bytes, line);) {
    take(line);
    // The same with a checksum that is right.
    unsigned sum = 0;
    for (const char c : line) sum ^= static_cast<unsigned char>(c);
    char tail[8];
    std::snprintf(tail, sizeof tail, "*%02X", sum & 0xff);
    take("$" + std::string(line) + tail);
  }
  return 0;
}
