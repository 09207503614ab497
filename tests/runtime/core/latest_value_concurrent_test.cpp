#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

#include "runtime/core/latest_value.h"

namespace maploop::runtime {
namespace {

using Value = std::array<std::uint64_t, 16>;

TEST(LatestValueConcurrent, NeverTornAndNeverOld) {
  constexpr std::uint64_t value_count = 300000;
  LatestValue<Value> cell;
  std::atomic<bool> done{false};
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= value_count; ++i) {
      cell.back().fill(i);
      cell.publish();
      if (i % 64 == 0) std::this_thread::yield();
    }
    done = true;
  });
  std::uint64_t last = 0, wrong = 0;
  for (bool stop = false; !stop;) {
    stop = done;  // read before the last check, so that all published values are seen
    if (const Value* value = cell.latest()) {
      if (value->front() <= last) ++wrong;
      last = value->front();
      for (std::uint64_t word : *value) wrong += word != last ? 1 : 0;
    }
  }
  writer.join();
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(last, value_count) << "the newest is never lost";
}

}  // namespace
}  // namespace maploop::runtime
