// Tests what a wrong description of a car makes of its sensors.
#include "tools/replay/misdescription.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "msgs/frames.h"

namespace maploop::tools {
namespace {

template <class T>
T only(std::unique_ptr<sensors::Source<T>>& source) {
  T sample;
  EXPECT_TRUE(source->next(sample));
  return sample;
}

template <class T>
std::unique_ptr<sensors::Source<T>> source_of(const T& given) {
  return sensors::made<T>([given, left = 1](T& sample, sensors::SourceReport&) mutable {
    sample = given;
    return left-- > 0;
  });
}

TEST(Misdescription, EachPartOfEverythingIsThatOfThePropertyAlone) {
  const Misdescription all = misdescription(Property::everything, 7);
  EXPECT_EQ(misdescription(Property::antenna, 7).antenna, all.antenna);
  EXPECT_EQ(misdescription(Property::mount, 7).mount, all.mount);
  EXPECT_EQ(misdescription(Property::axle, 7).axle, all.axle);
  EXPECT_EQ(misdescription(Property::gnss_stamps, 7).gnss_stamps, all.gnss_stamps);
  EXPECT_EQ(misdescription(Property::antenna, 7).axle, 0.0);
  EXPECT_NEAR(all.antenna.norm(), 0.5, 1e-12);
  EXPECT_NEAR(std::abs(all.camera_yaw), radians(1.0), 1e-12);
  EXPECT_EQ(std::chrono::abs(all.imu_stamps), std::chrono::milliseconds(30));
}

TEST(Misdescription, OfTheMountTurnsWhatTheUnitMeasures) {
  ImuSample level;
  level.six_axes = true;
  level.specific_force_up = 10.0;
  level.yaw_rate = 0.5;
  vehicle::Sensors s;
  s.imu = source_of(level);
  const Misdescription wrong = misdescription(Property::mount, 3);
  misdescribe(s, wrong, {});
  const ImuSample sample = only(s.imu);
  EXPECT_NEAR(std::abs(sample.specific_force_forward), 10.0 * std::sin(radians(1.0)), 0.01);
  EXPECT_NEAR(std::abs(sample.specific_force_left), 10.0 * std::sin(radians(1.0)), 0.01);
  EXPECT_NEAR(sample.yaw_rate, 0.5, 1e-3);
}

TEST(Misdescription, OfTheCamerasPlaceMovesTheBodySidewaysInATurn) {
  RelativeMotion turn;
  turn.status = OdometryStatus::ok;
  turn.rotation = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ());
  vehicle::Sensors s;
  s.odometry = source_of(turn);
  Misdescription wrong;
  wrong.camera_place = {0.0, 0.5, 0.0};
  misdescribe(s, wrong, {});
  const RelativeMotion seen = only(s.odometry);
  EXPECT_NEAR(seen.translation.x(), 0.5 * std::sin(0.1), 1e-9) << "m, ahead in a turn to the left";
  EXPECT_NEAR(seen.rotation.angularDistance(turn.rotation), 0.0, 1e-9);
}

TEST(Misdescription, AStampThatIsLateComesLate) {
  GnssFix fix;
  fix.stamp = fix.velocity_stamp = fix.available = Time{} + std::chrono::seconds(100);
  for (const int by : {30, -30}) {
    vehicle::Sensors s;
    s.gnss = source_of(fix);
    Misdescription wrong;
    wrong.gnss_stamps = std::chrono::milliseconds(by);
    misdescribe(s, wrong, {});
    const GnssFix seen = only(s.gnss);
    EXPECT_EQ(seen.stamp, fix.stamp + wrong.gnss_stamps);
    EXPECT_EQ(seen.velocity_stamp, seen.stamp);
    EXPECT_GE(seen.available, seen.stamp);
  }
}

}  // namespace
}  // namespace maploop::tools
