#include "runtime/vehicle/playback/player.h"

#include <gtest/gtest.h>

#include <deque>
#include <memory>
#include <thread>
#include <vector>

#include "tests/runtime/vehicle/driven.h"

namespace maploop::vehicle {
namespace {

using std::chrono::milliseconds;

using maploop::testing::MessageTape;

constexpr double drive_seconds = 4.0;

std::unique_ptr<Vehicle> make_vehicle(MessageTape& tape) {
  return std::make_unique<Vehicle>(
      VehicleConfig{}, testing::fake_calibration(), testing::fake_sensors(drive_seconds),
      runtime::DataClock::paced(1.0), std::vector<MessageSink*>{&tape}, Observer{});
}

MessageTape::Channels driven_at_once() {
  return testing::drive({.sensors = testing::fake_sensors(drive_seconds)}).messages;
}

class PlayerTest : public ::testing::Test {
 protected:
  void SetUp() override { start({}); }

  void start(PlayerParameters parameters) {
    parameters.first = testing::drive_start;
    parameters.last = testing::drive_start + from_seconds(drive_seconds);
    player_ = std::make_unique<Player>(
        [this](const Snapshot* from) {
          if (from != nullptr) resumed_at_.push_back(from->at);
          auto vehicle = make_vehicle(tapes_.emplace_back());
          if (from != nullptr) vehicle->resume(*from);
          return vehicle;
        },
        parameters);
    player_->start();
  }
  // Starts again with other parameters.
  void start_again(const PlayerParameters& parameters) {
    player_.reset();
    tapes_.clear();
    start(parameters);
  }

  Player& player() { return *player_; }
  Vehicle& vehicle() { return player_->vehicle(); }

  // The length of the drive bounds this.
  void play_until(Time t) {
    while (vehicle().position() < t && player().update()) tick();
  }
  void play_to_end() {
    while (player().update()) tick();
    vehicle().wait();
  }
  void arrive() {
    while (player().seeking() && player().update()) tick();
  }
  static void tick() { std::this_thread::sleep_for(milliseconds(5)); }
  // Waits, while paused, until everything due is done, and checks it again a moment later: a slow
  // machine is behind, and a stall that it notices late takes the clock back before its pause.
  // Bounded.
  void settle() {
    const auto done = [&] {
      return player().paused() && vehicle().next_sample() > vehicle().clock().now();
    };
    for (int i = 0; i < 40; ++i) {
      for (int k = 0; k < 1000 && !done(); ++k) tick();
      std::this_thread::sleep_for(milliseconds(200));
      if (done()) return;
    }
  }

  std::deque<MessageTape> tapes_;  // one for each vehicle
  std::vector<Time> resumed_at_;

 private:
  std::unique_ptr<Player> player_;
};

TEST_F(PlayerTest, PauseHoldsTimeAndResumeChangesNoBit) {
  play_until(vehicle().first() + milliseconds(300));
  player().pause();
  settle();
  const Time held = vehicle().position();
  settle();
  EXPECT_TRUE(player().paused());
  EXPECT_EQ(vehicle().position(), held);
  player().resume();
  player().set_speed(20.0);
  play_to_end();
  EXPECT_GT(vehicle().position(), held);
  EXPECT_EQ(tapes_.back().all(), driven_at_once());
}

TEST_F(PlayerTest, AStepGoesToTheNextSampleOrImageAndNoFurther) {
  const auto step_until = [&](auto&& passed) {
    for (int i = 0; i < 2000 && !passed(); ++i) tick();  // bounded
    settle();
    EXPECT_TRUE(passed()) << "it has been released";
    EXPECT_TRUE(player().paused());
  };
  player().pause();  // at once, because the inertial samples end before the images
  settle();
  const Time sample = vehicle().next_sample();
  player().step_sample();
  step_until([&] { return vehicle().next_sample() > sample; });
  EXPECT_EQ(vehicle().clock().now(), sample);
  const Time image = vehicle().next_image();
  player().step_image();
  step_until([&] { return vehicle().next_image() > image; });
  EXPECT_EQ(vehicle().clock().now(), image);
  EXPECT_LE(vehicle().position(), image);
  EXPECT_GT(vehicle().position(), image - milliseconds(10));
}

TEST_F(PlayerTest, SeekArrivesWithTheStateOfHavingDrivenThere) {
  const Time target = vehicle().first() + milliseconds(2500);
  ASSERT_TRUE(player().seek(target));
  arrive();
  EXPECT_GE(vehicle().position() + milliseconds(10), target);
  EXPECT_FALSE(player().seek(player().first() - milliseconds(1))) << "before the drive";
  EXPECT_FALSE(player().seek(player().last() + milliseconds(1))) << "after the drive";
  player().set_speed(20.0);
  play_to_end();
  EXPECT_EQ(tapes_.back().all(), driven_at_once());
}

TEST_F(PlayerTest, SeekWhilePausedIsPausedOnArrival) {
  player().pause();
  settle();
  const Time target = vehicle().first() + milliseconds(1500);
  ASSERT_TRUE(player().seek(target));
  arrive();
  settle();
  EXPECT_TRUE(player().paused());
  EXPECT_LE(vehicle().position(), target);
}

TEST_F(PlayerTest, ASeekDoesNotPassItsTargetWhereNobodyLooksOnArrival) {
  const Time target = vehicle().first() + milliseconds(500);
  ASSERT_TRUE(player().seek(target));
  player().pause();
  EXPECT_FALSE(player().paused()) << "it is on its way";
  std::this_thread::sleep_for(milliseconds(600));
  EXPECT_LE(vehicle().position(), target);
  arrive();
  settle();
  EXPECT_TRUE(player().paused());
  EXPECT_LE(vehicle().position(), target);
}

TEST_F(PlayerTest, ResumeDuringASeekGoesOnFromThere) {
  player().pause();
  settle();
  const Time target = vehicle().first() + milliseconds(1000);
  ASSERT_TRUE(player().seek(target));
  player().step_image();
  player().resume();
  arrive();
  play_until(target + milliseconds(200));
  EXPECT_GE(vehicle().position(), target + milliseconds(200));
  EXPECT_FALSE(player().paused());
}

TEST_F(PlayerTest, SeekBackGoesOnFromTheSnapshotBeforeAsIfItHadComeThereDirectly) {
  PlayerParameters parameters;
  parameters.snapshot_every = milliseconds(500);
  start_again(parameters);
  ASSERT_TRUE(player().seek(player().first() + milliseconds(2700)));
  arrive();
  const Time target = player().first() + milliseconds(1300);
  ASSERT_TRUE(player().seek(target));
  arrive();
  EXPECT_GE(vehicle().position() + milliseconds(10), target);
  EXPECT_LT(vehicle().position(), target + milliseconds(500));
  ASSERT_EQ(resumed_at_, std::vector<Time>{player().first() + milliseconds(1000)});
  player().set_speed(20.0);
  play_to_end();
  EXPECT_EQ(tapes_.back().all(), after(driven_at_once(), resumed_at_.back()));
}

TEST_F(PlayerTest, SeekBackWithoutASnapshotStartsAgain) {
  PlayerParameters parameters;
  parameters.snapshots = 0;
  start_again(parameters);
  ASSERT_TRUE(player().seek(player().first() + milliseconds(2000)));
  arrive();
  ASSERT_TRUE(player().seek(player().first() + milliseconds(300)));
  arrive();
  EXPECT_TRUE(resumed_at_.empty());
  EXPECT_EQ(tapes_.size(), 2u);
  player().set_speed(20.0);
  play_to_end();
  EXPECT_EQ(tapes_.back().all(), driven_at_once());
}

TEST_F(PlayerTest, SeekBackKeepsPauseAndSpeed) {
  player().set_speed(3.0);
  play_until(player().first() + milliseconds(1500));
  player().pause();
  settle();
  const Time target = player().first() + milliseconds(500);
  ASSERT_TRUE(player().seek(target));
  arrive();
  settle();
  player().update();
  EXPECT_TRUE(player().paused());
  EXPECT_EQ(player().speed(), 3.0);
  EXPECT_LE(player().position(), target);
  EXPECT_GT(player().position(), target - milliseconds(20));
}

TEST_F(PlayerTest, EachPassHasTheSameBits) {
  PlayerParameters parameters;
  parameters.passes = 3;
  start_again(parameters);
  player().set_speed(20.0);
  play_to_end();
  EXPECT_EQ(player().speed(), 20.0);
  ASSERT_EQ(tapes_.size(), 3u);
  const auto reference = driven_at_once();
  for (const MessageTape& tape : tapes_) EXPECT_EQ(tape.all(), reference);
}

TEST_F(PlayerTest, EachPassGoesToItsStartAsFastAsItCan) {
  PlayerParameters parameters;
  parameters.passes = 2;
  parameters.start = testing::drive_start + milliseconds(3700);
  start_again(parameters);
  EXPECT_TRUE(player().seeking());
  play_to_end();
  ASSERT_EQ(tapes_.size(), 2u);
  const auto reference = driven_at_once();
  for (const MessageTape& tape : tapes_) EXPECT_EQ(tape.all(), reference);
}

TEST_F(PlayerTest, QuitEndsAllPasses) {
  PlayerParameters parameters;
  parameters.passes = 1000;
  start_again(parameters);
  play_until(player().first() + milliseconds(200));
  player().quit();
  play_to_end();
  EXPECT_EQ(tapes_.size(), 1u);
}

TEST(SnapshotRing, KeepsToItsSizeAndReachesOverTheWholeDrive) {
  SnapshotRing ring(8);
  const auto at = [](int i) { return testing::drive_start + std::chrono::seconds(i); };
  EXPECT_FALSE(ring.before(at(1000)));
  for (int i = 1; i <= 1000; ++i) {
    ring.add({at(i), at(0), {}});
    ASSERT_LE(ring.size(), 8u);
  }
  EXPECT_EQ(ring.before(at(2000))->at, at(1000)) << "the last one is there";
  EXPECT_FALSE(ring.before(at(0)));
  ASSERT_TRUE(ring.before(at(999)));
  EXPECT_GE(ring.before(at(999))->at, at(990)) << "close together where it was last";
  ring.add({at(1000), at(0), {{"stereo", {1}}}});
  EXPECT_TRUE(ring.before(at(1000))->parts.empty()) << "one that is known is kept";
}

}  // namespace
}  // namespace maploop::vehicle
