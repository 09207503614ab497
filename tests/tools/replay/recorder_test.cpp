// Tests the recorder of MCAP files.
#include "tools/replay/recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>
#include <vector>

#include "msgs/lcm/checked_decode.h"
#include "sensors/replay/log_events.h"
#include "tests/support/error_of.h"
#include "tests/support/real_data.h"
#include "tests/support/small_disk.h"

namespace maploop::tools {
namespace {

using sensors::LogEvents;
using ::testing::AllOf;
using ::testing::HasSubstr;
using vehicle::LogRecorder;

constexpr std::int64_t start = 1'317'042'651'174'740'992;

class McapRecorder : public ::testing::Test {
 protected:
  std::unique_ptr<LogRecorder> recorder() const {
    return make_recorder(file, false, LogRecorder::WhenBehind::wait);
  }

  // Sends a message of a type that nothing shows, a tenth of a second after the one before.
  void send(LogRecorder& to, std::size_t size) {
    std::vector<std::uint8_t> data(size);
    for (std::uint8_t& byte : data)
      byte = static_cast<std::uint8_t>((random_ = random_ * 69069 + 1) >> 24U);
    to.send({"RAW", from_nanoseconds(start + 100'000'000 * sent_++), data, true});
    data_.push_back(data);
  }

  // Returns the numbers of the messages sent that the file has, and how often it is damaged.
  std::pair<std::vector<std::size_t>, int> read() const {
    const auto log = sensors::open_log(file, schema::own_schema());
    std::pair<std::vector<std::size_t>, int> found;
    std::size_t next = 0;
    for (auto item = log->next(); item != LogEvents::Item::end; item = log->next()) {
      if (item == LogEvents::Item::damage) {
        ++found.second;
        continue;
      }
      const auto bytes = log->event().data;
      while (next < data_.size() && !std::ranges::equal(data_[next], bytes)) ++next;
      EXPECT_LT(next, data_.size()) << "a message that was not sent, or out of order";
      found.first.push_back(next++);
    }
    return found;
  }

  const maploop::testing::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "a.mcap";
  std::vector<std::vector<std::uint8_t>> data_;
  std::uint32_t random_ = 1;
  int sent_ = 0;
};

TEST_F(McapRecorder, HoldsWhatWasSent) {
  {
    const auto to = recorder();
    for (int i = 0; i < 50; ++i) send(*to, 1000);
    to->flush();
    EXPECT_EQ(read().first.size(), 50U) << "all that was flushed, before the file has its end";
    EXPECT_EQ(read().second, 1) << "which it lacks";
    send(*to, 10);
  }
  EXPECT_TRUE(sensors::is_own_recording(file));
  EXPECT_EQ(read().first.size(), 51U);
  EXPECT_EQ(read().second, 0);
}

TEST_F(McapRecorder, LosesAtMostASecondWhenItIsKilled) {
  const auto to = recorder();
  for (int i = 0; i < 50; ++i) send(*to, 1000);
  for (int i = 0; i < 100 && read().first.size() < 39; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_GE(read().first.size(), 39U);
}

TEST_F(McapRecorder, OnAFullDiskHoldsEveryMessageThatIsNotCountedAsUnsent) {
  OutputHealth health;
  {
    const auto to = recorder();
    {
      const maploop::testing::SmallDisk disk(200'000);
      for (int i = 0; i < 100; ++i) send(*to, 10'000);
      to->flush();
      health = to->health();
      EXPECT_GT(health.sent, 10U);
      EXPECT_GT(health.unsent, 70U);
      EXPECT_EQ(health.sent + health.unsent, 100U);
      EXPECT_EQ(read().first.size(), health.sent);
    }
    for (int i = 0; i < 20; ++i) send(*to, 10'000);
    to->flush();
    EXPECT_EQ(to->health().sent, health.sent + 20) << "there is room again";
  }
  EXPECT_EQ(read().first.size(), health.sent + 20);
  EXPECT_EQ(read().second, 0) << "the index leaves out what is not there";
}

TEST_F(McapRecorder, FromAFullDiskOnIsAFileAsSoonAsThereIsRoom) {
  {
    const auto to = recorder();
    {
      const maploop::testing::SmallDisk disk(1000);
      send(*to, 10'000);
      to->flush();
      EXPECT_EQ(to->health().unsent, 1U);
    }
    send(*to, 10'000);
  }
  EXPECT_EQ(read(), std::pair(std::vector<std::size_t>{1}, 0));
}

TEST_F(McapRecorder, IsOfOneRecording) {
  const auto first = recorder();
  EXPECT_THAT(maploop::testing::error_of([&] { recorder(); }),
              AllOf(HasSubstr("a.mcap"), HasSubstr("another run")));
}

TEST(Recorder, ABagIsRefusedWithWhatToDo) {
  EXPECT_THAT(maploop::testing::error_of(
                  [] { make_recorder("a.bag", false, LogRecorder::WhenBehind::wait); }),
              AllOf(HasSubstr("a.bag"), HasSubstr("maploop log convert")));
}

}  // namespace
}  // namespace maploop::tools
