// Tests a long run on synthetic sensors with faults now and then: memory stays constant, every loss
// is counted, and no thread ends. MAPLOOP_SOAK_SECONDS lengthens it (of data; virtual time). It
// takes 15 s, because a leak of a few bytes a tick shows only over minutes of data.
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "runtime/vehicle/faults/fault_injection.h"
#include "runtime/vehicle/output/channel_hashes.h"
#include "tests/runtime/vehicle/fake_sensors.h"

namespace maploop::vehicle {
namespace {

using testing::drive_start;

double soak_seconds() {
  const char* asked = std::getenv("MAPLOOP_SOAK_SECONDS");
  return asked != nullptr ? std::stod(asked) : 300.0;
}

std::size_t bytes_in_use() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

TEST(Soak, MemoryStaysFlatAndLossesBalance) {
  const double seconds = soak_seconds();
  const Time warm = drive_start + from_seconds(0.2 * seconds);
  const Time half = drive_start + from_seconds(0.6 * seconds);
  std::vector<Fault> faults;
  for (const char* fault :
       {"lost@imu,share=0.02", "duplicated@imu,share=0.02", "reordered@imu,share=0.02",
        "nan@imu,share=0.02", "garbage@camera,share=0.02", "late@gnss,share=0.2,by=0.5"}) {
    faults.push_back(parse_fault(fault));
  }
  FaultInjection injection(std::move(faults), drive_start, testing::fake_calibration().stereo.fx);
  ChannelHashes hashes;
  // These are the least bytes in use, because what threads hold for a moment varies with the
  // machine's load.
  std::size_t when_warm = std::numeric_limits<std::size_t>::max(), later = when_warm;
  std::uint64_t states = 0;
  Observer observer;
  observer.nav_state = [&](const NavState& state) {
    ++states;
    if (state.stamp < warm) return;
    std::size_t& least = state.stamp < half ? when_warm : later;
    least = std::min(least, bytes_in_use());
  };
  Vehicle vehicle({}, testing::fake_calibration(), injection.inject(testing::fake_sensors(seconds)),
                  runtime::DataClock::virtual_time(), {&hashes}, observer);
  vehicle.start();
  vehicle.wait();

  // A leak of 8 bytes a tick would be 96 kB between the two.
  EXPECT_LT(later, when_warm + (std::size_t{64} << 10)) << "bytes in use";
  EXPECT_GT(static_cast<double>(states), 99.0 * seconds);
  const VehicleReport report = vehicle.report();
  for (const ThreadHealth& thread : report.health.threads) {
    EXPECT_EQ(thread.failure, "") << thread.name;
  }
  for (const RingHealth& ring : report.health.rings) {
    EXPECT_EQ(ring.pushed, ring.popped + ring.lost + ring.held) << ring.name;
    EXPECT_EQ(ring.lost, 0U) << ring.name << ": a replay keeps all";
  }
  for (const FaultCount& fault : injection.counts()) EXPECT_GT(fault.struck, 0U) << fault.fault;
}

}  // namespace
}  // namespace maploop::vehicle
