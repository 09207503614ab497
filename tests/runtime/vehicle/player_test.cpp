#include "runtime/vehicle/player.h"

#include <gtest/gtest.h>

#include <string>
#include <thread>

#include "runtime/vehicle/channel_hashes.h"
#include "tests/runtime/vehicle/fake_sensors.h"

namespace maploop::vehicle {
namespace {

using runtime::DataClock;
using std::chrono::milliseconds;

std::string lockstep_hash(double seconds) {
  ChannelHashes hashes;
  Vehicle vehicle({}, testing::fake_calibration(), testing::fake_sensors(seconds),
                  DataClock::virtual_time(), {&hashes}, {});
  vehicle.start();
  vehicle.wait();
  return hashes.summary().at("NAV_STATE").hash;
}

class PlayerTest : public ::testing::Test {
 protected:
  PlayerTest()
      : vehicle({}, testing::fake_calibration(), testing::fake_sensors(seconds),
                DataClock::paced(1.0), {&hashes}, {}),
        player(vehicle) {
    vehicle.start();
  }

  // Bounded by the length of the drive.
  void play_until(Time t) {
    while (vehicle.running() && vehicle.position() < t) tick();
  }
  void play_to_end() {
    while (vehicle.running()) tick();
    vehicle.wait();
  }
  void tick() {
    player.update();
    std::this_thread::sleep_for(milliseconds(5));
  }
  // Long enough for everything that is due to be done.
  static void settle() { std::this_thread::sleep_for(milliseconds(200)); }

  static constexpr double seconds = 4.0;
  ChannelHashes hashes;
  Vehicle vehicle;
  Player player;
};

TEST_F(PlayerTest, PauseHoldsTimeAndResumeChangesNoBit) {
  play_until(vehicle.first() + milliseconds(300));
  player.pause();
  settle();
  const Time held = vehicle.position();
  settle();
  EXPECT_TRUE(player.paused());
  EXPECT_EQ(vehicle.position(), held);
  player.resume();
  player.set_speed(20.0);
  play_to_end();
  EXPECT_GT(vehicle.position(), held);
  EXPECT_EQ(hashes.summary().at("NAV_STATE").hash, lockstep_hash(seconds));
}

TEST_F(PlayerTest, AStepGoesToTheNextImageAndNoFurther) {
  play_until(vehicle.first() + milliseconds(300));
  player.pause();
  settle();
  const Time next = vehicle.next_image();
  player.step_image();
  settle();
  EXPECT_TRUE(player.paused());
  EXPECT_LE(vehicle.position(), next);
  EXPECT_GT(vehicle.position(), next - milliseconds(10));
  EXPECT_GT(vehicle.next_image(), next) << "that image has been released";
}

TEST_F(PlayerTest, AStepGoesToTheNextSample) {
  play_until(vehicle.first() + milliseconds(300));
  player.pause();
  settle();
  const Time next = vehicle.next_sample();
  player.step_sample();
  settle();
  EXPECT_GT(vehicle.next_sample(), next);
  EXPECT_LE(vehicle.next_sample(), next + milliseconds(20)) << "the IMU's period is 10 ms";
}

TEST_F(PlayerTest, SeekArrivesWithTheStateOfHavingDrivenThere) {
  const Time target = vehicle.first() + milliseconds(2500);
  ASSERT_TRUE(player.seek(target));
  while (player.seeking()) tick();
  EXPECT_GE(vehicle.position() + milliseconds(10), target);
  EXPECT_FALSE(player.seek(vehicle.first())) << "behind";
  player.set_speed(20.0);
  play_to_end();
  EXPECT_EQ(hashes.summary().at("NAV_STATE").hash, lockstep_hash(seconds));
}

TEST_F(PlayerTest, SeekWhilePausedIsPausedOnArrival) {
  player.pause();
  settle();
  const Time target = vehicle.first() + milliseconds(1500);
  ASSERT_TRUE(player.seek(target));
  while (player.seeking()) tick();
  settle();
  EXPECT_TRUE(player.paused());
  EXPECT_LE(vehicle.position(), target);
}

}  // namespace
}  // namespace maploop::vehicle
