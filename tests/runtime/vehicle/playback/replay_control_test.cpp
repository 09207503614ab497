// Tests the player under commands of LCM messages, on a bus inside this process.
#include "runtime/vehicle/playback/replay_control.h"

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include <lcm/lcm-cpp.hpp>
#include <limits>
#include <maploop_lcm/replay_control_t.hpp>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "msgs/lcm/checked_decode.h"
#include "tests/runtime/vehicle/fake_sensors.h"

namespace maploop::vehicle {
namespace {

using ::testing::HasSubstr;
using Control = maploop_lcm::replay_control_t;
using std::chrono::milliseconds;

class ReplayControlTest : public ::testing::Test {
 protected:
  ReplayControlTest()
      : player_(
            [](const Snapshot* from) {
              auto vehicle = std::make_unique<Vehicle>(
                  VehicleConfig{}, testing::fake_calibration(), testing::fake_sensors(4.0),
                  runtime::DataClock::paced(1.0), std::vector<MessageSink*>{}, Observer{});
              if (from != nullptr) vehicle->resume(*from);
              return vehicle;
            },
            {.first = testing::drive_start,
             .last = testing::drive_start + std::chrono::seconds(4)}) {}

  void SetUp() override {
    ASSERT_TRUE(lcm_.good());
    lcm_.subscribe("REPLAY_CONTROL", &ReplayControlTest::hear, this);
    player_.start();
    control_ = std::make_unique<ReplayControl>(lcm_, player_, run);
    look();
    ASSERT_FALSE(states_.empty()) << "it says where it begins";
  }

  void hear(const lcm::ReceiveBuffer* buffer, const std::string&) {
    Control message{};
    const std::span data(static_cast<const std::uint8_t*>(buffer->data), buffer->data_size);
    const bool decoded = schema::checked_decode(schema_, data, message);
    if (decoded && message.kind == Control::STATE) states_.push_back(message);
  }

  // Runs a few rounds of what the replay's thread does.
  void look(int rounds = 4) {
    for (int i = 0; i < rounds; ++i) {
      player_.update();
      control_->update();
      std::this_thread::sleep_for(milliseconds(20));
    }
  }

  // Runs while it seeks, with a bound that allows for a loaded machine.
  void look_until_arrived() {
    for (int i = 0; i < 1500 && state().seeking != 0; ++i) look(1);
    look();
  }

  static constexpr const char* run = "0123abcd";

  void command(int kind, double value = 0.0, const std::string& to = run) {
    Control message{};
    message.kind = static_cast<std::int8_t>(kind);
    message.value = value;
    message.run = to;
    ASSERT_EQ(lcm_.publish("REPLAY_CONTROL", &message), 0);
    look();
  }

  const Control& state() const { return states_.back(); }
  double position() const {
    return 1e-9 * static_cast<double>(state().position_ns - state().first_ns);
  }

  schema::Schema schema_{schema::own_types()};
  lcm::LCM lcm_{"memq://"};
  Player player_;
  std::unique_ptr<ReplayControl> control_;
  std::vector<Control> states_;
};

TEST_F(ReplayControlTest, SaysWhatTheDriveIs) {
  EXPECT_EQ(from_nanoseconds(state().first_ns), testing::drive_start);
  EXPECT_EQ(state().last_ns - state().first_ns, 4'000'000'000);
  EXPECT_EQ(state().speed, 1.0);
  EXPECT_EQ(state().paused, 0);
  EXPECT_EQ(state().refused, "");
}

TEST_F(ReplayControlTest, PausesAndResumes) {
  command(Control::PAUSE);
  // A stall that is noticed late takes the clock back before its pause for a moment.
  for (int i = 0; i < 500 && state().paused != 1; ++i) look(1);
  EXPECT_EQ(state().paused, 1);
  std::size_t said = 0;  // states sent earlier arrive first
  for (int i = 0; i < 50 && states_.size() != said; ++i) {
    said = states_.size();
    look(20);
  }
  const double held_at = position();
  for (int i = 0; i < 500 && states_.size() < said + 3; ++i) look(1);
  EXPECT_GE(states_.size(), said + 3) << "a paused run repeats its state, for those who join late";
  EXPECT_EQ(position(), held_at);
  said = states_.size();
  command(Control::RESUME);
  EXPECT_EQ(state().paused, 0);
  look(30);
  EXPECT_GT(states_.size(), said + 2) << "the position is said while it plays";
}

TEST_F(ReplayControlTest, StepsByImageAndBySample) {
  command(Control::PAUSE);
  look(10);
  const Time next_image = player_.vehicle().next_image();
  command(Control::STEP_IMAGE);
  const auto image_seen = [&] { return player_.vehicle().next_image() > next_image; };
  for (int i = 0; i < 1500 && !(image_seen() && state().paused == 1); ++i) look(1);
  EXPECT_EQ(state().paused, 1);
  EXPECT_GT(player_.vehicle().next_image(), next_image);
  const Time next_sample = player_.vehicle().next_sample();
  command(Control::STEP_SAMPLE);
  const auto sample_seen = [&] { return player_.vehicle().next_sample() > next_sample; };
  for (int i = 0; i < 1500 && !(sample_seen() && state().paused == 1); ++i) look(1);
  EXPECT_EQ(state().paused, 1);
  EXPECT_GT(player_.vehicle().next_sample(), next_sample);
}

TEST_F(ReplayControlTest, SeeksBothWays) {
  command(Control::PAUSE);
  command(Control::SEEK, 3.0);
  look_until_arrived();
  EXPECT_EQ(state().seeking, 0);
  // The overshoot depends on the machine: arrival is noticed only at the next look.
  constexpr double beyond = 0.5;
  EXPECT_GT(position(), 2.97);
  EXPECT_LT(position(), 3.0 + beyond);
  command(Control::SEEK, 1.0);
  look_until_arrived();
  EXPECT_GT(position(), 0.97);
  EXPECT_LT(position(), 1.0 + beyond);
  EXPECT_EQ(state().paused, 1) << "paused before, paused on arrival";
}

TEST_F(ReplayControlTest, ChangesTheSpeed) {
  command(Control::SPEED, 2.5);
  EXPECT_EQ(state().speed, 2.5);
  EXPECT_EQ(state().refused, "");
}

TEST_F(ReplayControlTest, PlaysToTheNextMiss) {
  command(Control::PAUSE);
  command(Control::SPEED, 1000.0);  // stereo must miss
  command(Control::NEXT_MISS);
  EXPECT_EQ(state().refused, "");
  // If the whole drive passed before the first look, it has ended. A graph that is behind stalls
  // the clock, and reaches the pause later.
  const auto held = [&] { return state().paused != 0 || !player_.vehicle().running(); };
  for (int i = 0; i < 500 && (player_.vehicle().deadline_misses() == 0 || !held()); ++i) look(1);
  EXPECT_TRUE(held());
}

TEST_F(ReplayControlTest, Quits) {
  EXPECT_FALSE(control_->quit());
  command(Control::QUIT);
  EXPECT_TRUE(control_->quit());
  for (int i = 0; i < 200 && player_.update(); ++i) look(1);
  EXPECT_FALSE(player_.vehicle().running());
}

TEST_F(ReplayControlTest, BadCommandsAreRefusedWithTheirReason) {
  command(Control::SEEK, 99.0);
  EXPECT_EQ(state().refused, "seek to 99 s: the drive goes from 0 s to 4 s");
  command(Control::SEEK, -1.0);
  EXPECT_NE(state().refused, "");
  command(Control::SEEK, std::numeric_limits<double>::quiet_NaN());
  EXPECT_NE(state().refused, "");
  command(Control::SPEED, 0.0);
  EXPECT_THAT(state().refused, HasSubstr("above 0"));
  EXPECT_EQ(state().speed, 1.0);
  command(Control::SPEED, std::numeric_limits<double>::infinity());
  EXPECT_NE(state().refused, "");
  command(77);
  EXPECT_EQ(state().refused, "unknown command 77");
  command(Control::PAUSE);
  EXPECT_EQ(state().refused, "") << "one that is obeyed clears it";
}

TEST_F(ReplayControlTest, OnlyCommandsForItsRunAreObeyed) {
  EXPECT_EQ(state().run, run);
  command(Control::SPEED, 2.0, "ffffffff");
  EXPECT_EQ(state().speed, 1.0);
  EXPECT_EQ(state().refused, "") << "it is another's to answer";
  command(Control::QUIT, 0.0, "");
  EXPECT_FALSE(control_->quit());
  EXPECT_EQ(state().refused, "the command has no run; this run is 0123abcd");
  command(Control::SPEED, 2.0);
  EXPECT_EQ(state().speed, 2.0);
}

TEST_F(ReplayControlTest, AMessageOfAnotherTypeIsRefused) {
  const std::string noise = "not a command";
  ASSERT_EQ(lcm_.publish("REPLAY_CONTROL", noise.data(), static_cast<unsigned>(noise.size())), 0);
  look();
  EXPECT_THAT(state().refused, HasSubstr("replay_control_t"));
}

TEST_F(ReplayControlTest, AMessageWhoseTextHasNoEndIsRefused) {
  const Control pause = [] {
    Control message{};
    message.kind = Control::PAUSE;
    message.run = run;
    return message;
  }();
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(pause.getEncodedSize()));
  pause.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  bytes[bytes.size() - 2] = 0;  // the length of `refused` with its terminator, which was 1
  ASSERT_EQ(lcm_.publish("REPLAY_CONTROL", bytes.data(), static_cast<unsigned>(bytes.size())), 0);
  look();
  EXPECT_THAT(state().refused, HasSubstr("replay_control_t"));
  EXPECT_EQ(state().paused, 0);
}

}  // namespace
}  // namespace maploop::vehicle
