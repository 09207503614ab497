// Tests black boxes: what is written to the ring is what a log of it holds.
#include <gmock/gmock.h>

#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>

#include "msgs/lcm/channel_names.h"
#include "runtime/vehicle/output/black_box.h"
#include "runtime/vehicle/output/black_box_file.h"
#include "runtime/vehicle/output/log_recorder.h"
#include "tests/tools/log/small_log.h"
#include "tools/log/log_tools.h"

namespace maploop::lcm_log {
namespace {

using ::testing::HasSubstr;
using vehicle::LogRecorder;

constexpr std::uint64_t small_box = 1'100'000;  // 16 blocks of 64 kB

class BlackBox : public ::testing::Test {
 protected:
  std::unique_ptr<LogRecorder> recorder(std::chrono::nanoseconds after = std::chrono::hours(1)) {
    return std::make_unique<LogRecorder>(box_.string(), true, LogRecorder::WhenBehind::wait,
                                         vehicle::black_box_format(small_box, after));
  }

  // Sends a message of another content each time, a tenth of a second after the one before.
  void send(LogRecorder& to, std::string channel, std::size_t size) {
    const TestEvent e{std::move(channel), test_start + 100'000 * static_cast<int>(sent_.size()),
                      unknown_bytes(size + sent_.size(), 1)};
    to.send({e.channel, from_nanoseconds(1000 * e.time_us), e.data, true});
    sent_.push_back(e);
  }

  std::vector<TestEvent> extracted() {
    said_.str("");
    black_box(box_, schema::own_schema(), out_, said_);
    return read_with_lcm(out_);
  }

  // Returns the newest events that were sent, as many as asked for.
  std::vector<TestEvent> newest(std::size_t count) const {
    return {sent_.end() - static_cast<std::ptrdiff_t>(count), sent_.end()};
  }

  // A number of the file's, not at its beginning.
  void damage(std::streamoff at) const {
    std::fstream file(box_, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(at);
    file.put('x');
  }

  const maploop::testing::TemporaryFolder folder_;
  const path box_ = folder_.path() / "run.box", out_ = folder_.path() / "out.lcmlog";
  std::vector<TestEvent> sent_;
  std::ostringstream said_;
};

TEST_F(BlackBox, HoldsAWholeShortRun) {
  const auto to = recorder();
  for (int i = 0; i < 20; ++i) send(*to, "RAW", 20'000);
  to->flush();
  EXPECT_EQ(extracted(), sent_) << "while the run goes on";
  EXPECT_THAT(said_.str(), HasSubstr("its run goes on, or did not end by itself"));
  send(*to, "RAW", 3);
  to->flush();
  EXPECT_EQ(extracted(), sent_) << "a block that was not full";
}

TEST_F(BlackBox, HoldsTheNewestEventsOfALongRun) {
  auto to = recorder();
  for (int i = 0; i < 300; ++i) {
    send(*to, "RAW", 20'000);
    if (i % 7 == 0) to->flush();
  }
  to.reset();
  const auto events = extracted();
  EXPECT_GT(events.size(), 45U) << "of 1.05 MB";
  EXPECT_EQ(events, newest(events.size()));
  EXPECT_THAT(said_.str(), HasSubstr("its run has ended"));
  EXPECT_THAT(said_.str(), HasSubstr("a replay starts anew"));
  EXPECT_EQ(std::filesystem::file_size(box_), 17U * vehicle::black_box::block_bytes);
}

TEST_F(BlackBox, AnEventMayBeLongerThanABlock) {
  const auto to = recorder();
  for (int i = 0; i < 12; ++i) send(*to, "RAW", i % 2 == 0 ? 300'000 : 100);
  to->flush();
  const auto events = extracted();
  EXPECT_GE(events.size(), 4U);
  EXPECT_EQ(events, newest(events.size()));
}

TEST_F(BlackBox, GivesASnapshotWithTheSecondsBeforeItAndTheCalibration) {
  auto to = recorder();
  send(*to, "CALIBRATION", 100);
  for (int i = 0; i < 400; ++i) send(*to, i % 25 == 24 ? "SNAPSHOT" : "RAW", 15'000);
  to.reset();
  const auto events = extracted();
  ASSERT_GT(events.size(), 2U);
  EXPECT_EQ(events[0], sent_[0]) << "the calibration, although the ring has left it behind";
  const auto snapshot = read_bytes(folder_.path() / "out.snapshot");
  const auto at = std::ranges::find(sent_, snapshot, &TestEvent::data);
  ASSERT_NE(at, sent_.end());
  EXPECT_EQ(at->channel, "SNAPSHOT");
  EXPECT_EQ(events[1].time_us, at->time_us - 2'000'000);
  EXPECT_EQ(events.back(), sent_[sent_.size() - 2]) << "the last one is a snapshot";
  EXPECT_THAT(said_.str(), HasSubstr("--resume"));
}

TEST_F(BlackBox, LeavesOutADamagedBlock) {
  auto to = recorder();
  for (int i = 0; i < 40; ++i) send(*to, "RAW", 10'000);
  to.reset();
  damage(3 * static_cast<std::streamoff>(vehicle::black_box::block_bytes) + 500);
  const auto events = extracted();
  EXPECT_THAT(said_.str(), HasSubstr("1 blocks of 65536 bytes are damaged"));
  EXPECT_GT(events.size(), 30U);
  EXPECT_LT(events.size(), 36U);
  for (const TestEvent& e : events) EXPECT_TRUE(std::ranges::count(sent_, e) == 1);
}

TEST_F(BlackBox, OfARunThatHasEndedIsNotFrozen) {
  {
    const auto to = recorder(std::chrono::seconds(10));
    send(*to, "RAW", 10);
  }
  EXPECT_TRUE(contains(error_of<std::runtime_error>([&] { vehicle::ask_to_freeze(box_); }),
                       "its run has ended"));
}

TEST_F(BlackBox, IsFrozenWhenSomebodyAsks) {
  const auto to = recorder(std::chrono::milliseconds(1));
  send(*to, "RAW", 100);
  to->flush();
  vehicle::ask_to_freeze(box_);
  const vehicle::black_box::File box(box_, vehicle::black_box::File::For::reading);
  for (int i = 0; i < 100 && box.read_head().frozen == 0; ++i) {
    send(*to, "RAW", 100);
    to->flush();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  EXPECT_EQ(box.read_head().frozen, 1U);
  const auto before = extracted();
  send(*to, "RAW", 100);
  to->flush();
  EXPECT_EQ(extracted(), before);
  EXPECT_EQ(to->health().unsent, 0U) << "nothing is lost that was asked for";
}

TEST_F(BlackBox, OfARunThatDidNotEndIsKeptAsEvidence) {
  {
    const vehicle::black_box::File left(box_, small_box);  // and nobody closes it
  }
  const path kept = box_.string() + ".kept";
  auto to = recorder();
  send(*to, "RAW", 100);
  to.reset();
  EXPECT_TRUE(exists(kept));
  recorder().reset();
  EXPECT_THROW(extracted(), std::runtime_error) << "one of a run that ended is replaced";
}

TEST_F(BlackBox, DoesNotReplaceAnotherFile) {
  write_bytes(box_, {1, 2, 3});
  EXPECT_THAT(error_of<std::runtime_error>([&] { recorder(); }), HasSubstr("another kind"));
  EXPECT_THAT(error_of<std::runtime_error>([&] { extracted(); }), HasSubstr("is no black box"));
  EXPECT_EQ(read_bytes(box_).size(), 3U);
}

TEST_F(BlackBox, OfAnotherRunThatWritesItIsRefused) {
  const auto to = recorder();
  EXPECT_THAT(error_of<std::runtime_error>([&] { recorder(); }), HasSubstr("another run"));
}

TEST_F(BlackBox, WithoutAnEventSaysSo) {
  recorder().reset();
  EXPECT_THAT(error_of<std::runtime_error>([&] { extracted(); }), HasSubstr("no event yet"));
  EXPECT_FALSE(exists(out_));
}

}  // namespace
}  // namespace maploop::lcm_log
