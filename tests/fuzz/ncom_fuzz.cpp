// NCOM packets, as they are and with checksums that are right.
#include <array>
#include <cmath>

#include "sensors/imu/ncom.h"
#include "tests/fuzz/fuzz_input.h"

using namespace maploop;
using namespace maploop::sensors;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  NcomClock clock;
  Time arrival = parse_time("2026-03-01 10:00:00"), last = Time::min();
  while (!input.empty()) {
    arrival += std::chrono::microseconds(input.number() % 100'000'000);
    const auto given = input.bytes(ncom_size);
    NcomFault fault{};
    parse_ncom(given, fault);
    std::array<std::uint8_t, ncom_size> packet{};
    std::copy(given.begin(), given.end(), packet.begin());
    packet[0] = 0xe7;
    unsigned sum = 0;
    for (std::size_t i = 1; i < 71; ++i) {
      if (i == 22 || i == 61) packet[i] = static_cast<std::uint8_t>(sum);
      sum += packet[i];
    }
    packet[71] = static_cast<std::uint8_t>(sum);
    const auto sample = parse_ncom(packet, fault);
    if (!sample) continue;
    fuzz::require(std::isfinite(sample->values.yaw_rate));
    if (const auto stamp = clock.stamp(sample->minute_ms, arrival)) {
      fuzz::require(*stamp > last);
      last = *stamp;
    }
  }
  return 0;
}
