#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

#include "runtime/core/asked_value.h"

namespace maploop::runtime {
namespace {

using Value = std::array<std::uint64_t, 16>;

TEST(AskedValue, IsGivenOnceForEachQuestion) {
  AskedValue<int> cell;
  const auto give = [&](int value) { return cell.offer([&](int& slot) { slot = value; }); };
  EXPECT_FALSE(give(1)) << "nobody has asked";
  EXPECT_EQ(cell.latest(), nullptr);
  cell.ask();
  cell.ask();
  EXPECT_TRUE(give(2));
  EXPECT_FALSE(give(3)) << "asked twice before the answer is asked once";
  const int* value = cell.latest();
  ASSERT_NE(value, nullptr);
  EXPECT_EQ(*value, 2);
  EXPECT_EQ(cell.latest(), nullptr);
}

TEST(AskedValueConcurrent, NeverTornAndEachAnswerIsNewer) {
  AskedValue<Value> cell;
  std::atomic<bool> done{false};
  std::thread writer([&] {
    for (std::uint64_t i = 1; !done; ++i) cell.offer([i](Value& slot) { slot.fill(i); });
  });
  std::uint64_t last = 0, wrong = 0;
  for (int answers = 0; answers < 2000;) {
    cell.ask();
    const Value* value = cell.latest();
    if (value == nullptr) {
      std::this_thread::yield();
      continue;
    }
    ++answers;
    if (value->front() <= last) ++wrong;
    last = value->front();
    for (const std::uint64_t word : *value) wrong += word != last ? 1 : 0;
  }
  done = true;
  writer.join();
  EXPECT_EQ(wrong, 0u);
}

}  // namespace
}  // namespace maploop::runtime
