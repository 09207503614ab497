// Tests what is said of offsets in time, and which part of a drive they are measured on.
#include "tools/doctor/time_offsets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sensors/source.h"

namespace maploop::tools {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(TimeOffsets, TheStretchIsWhereTheUnitTurnsMost) {
  vehicle::Recording recording;
  recording.first_stamp = from_nanoseconds(1'000'000'000);
  recording.sensors = [](Time) {
    vehicle::Sensors s;
    s.imu = sensors::made<ImuSample>([i = 0](ImuSample& sample, sensors::SourceReport&) mutable {
      const double t = 0.1 * i++;
      sample.stamp = from_nanoseconds(1'000'000'000) + from_seconds(t);
      sample.yaw_rate = t > 50.0 && t < 60.0 ? -0.5 : 0.01;
      return t < 200.0;
    });
    return s;
  };
  const extrinsics::Stretch stretch = turning_stretch(recording);
  EXPECT_LE(to_seconds(stretch.from - recording.first_stamp), 50.1);
  EXPECT_GE(to_seconds(stretch.to - recording.first_stamp), 59.9);
}

TEST(TimeOffsets, WithoutAnInertialUnitItIsTheBeginning) {
  vehicle::Recording recording;
  recording.first_stamp = from_nanoseconds(1'000'000'000);
  recording.sensors = [](Time) { return vehicle::Sensors(); };
  const extrinsics::Stretch stretch = turning_stretch(recording);
  EXPECT_EQ(stretch.from, recording.first_stamp);
  EXPECT_NEAR(to_seconds(stretch.to - stretch.from), 20.0, 1e-9);
  EXPECT_TRUE(time_offsets(recording, vehicle::VehicleConfig(), stretch).empty());
}

TEST(TimeOffsets, OnlyALargeOffsetIsWorthASentence) {
  const TimeOffset small{"imu", "camera", true, 12.0, 1.0, 0.9, ""};
  const TimeOffset uncertain{"imu", "lidar", true, 40.0, 20.0, 0.5, ""};
  const TimeOffset large{"camera", "lidar", true, 40.0, 2.0, 0.9, ""};
  const TimeOffset none{"imu", "camera", false, 0.0, 0.0, 0.1, "the vehicle hardly turns"};
  EXPECT_TRUE(advice({small, uncertain}, "a.bag").empty());
  EXPECT_THAT(advice({large}, "a.bag"),
              ElementsAre("The stamps of camera are 40 ms later than those of lidar.",
                          HasSubstr("maploop calibrate extrinsics a.bag")));
  EXPECT_THAT(advice({none}, "a.bag"), ElementsAre(HasSubstr("the vehicle hardly turns")));
}

}  // namespace
}  // namespace maploop::tools
