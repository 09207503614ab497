// Tests by which values a sensor is said to be cut off.
#include "tools/doctor/saturation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "sensors/source.h"

namespace maploop::tools {
namespace {

std::vector<double> measured(double quantum) {
  std::mt19937_64 engine(1);
  std::normal_distribution<double> normal;
  std::vector<double> values(5000);
  for (double& v : values) {
    v = normal(engine);
    if (quantum > 0.0) v = quantum * std::round(v / quantum);
  }
  return values;
}

std::vector<double> cut(std::vector<double> values, double least, double most) {
  for (double& v : values) v = std::clamp(v, least, most);
  return values;
}

TEST(IsCutOff, ValuesWithinTheRangeAreNot) {
  EXPECT_FALSE(is_cut_off(measured(0.0)));
  EXPECT_FALSE(is_cut_off(measured(0.01))) << "rounded finely";
  EXPECT_FALSE(is_cut_off(measured(0.5))) << "rounded coarsely";
}

TEST(IsCutOff, EitherEndMayBeCut) {
  EXPECT_TRUE(is_cut_off(cut(measured(0.0), -9.0, 2.0)));
  EXPECT_TRUE(is_cut_off(cut(measured(0.0), -2.0, 9.0)));
  EXPECT_TRUE(is_cut_off(cut(measured(0.01), -9.0, 2.0)));
}

TEST(IsCutOff, AFrozenSensorIsAnotherFault) {
  EXPECT_FALSE(is_cut_off(std::vector<double>(1000, 3.0)));
  EXPECT_FALSE(is_cut_off({}));
}

TEST(CutOffAxes, NamesTheAxisOfTheUnit) {
  const std::vector<double> rates = cut(measured(0.0), -1.5, 1.5), forces = measured(0.0);
  vehicle::Recording recording;
  recording.sensors = [&](Time) {
    vehicle::Sensors s;
    s.imu = sensors::made<ImuSample>(
        [&, i = std::size_t{0}](ImuSample& sample, sensors::SourceReport&) mutable {
          if (i == rates.size()) return false;
          sample.yaw_rate = rates[i];
          sample.specific_force_forward = forces[i];
          ++i;
          return true;
        });
    return s;
  };
  EXPECT_THAT(cut_off_axes(recording),
              ::testing::ElementsAre(::testing::HasSubstr("yaw rate of imu is cut off")));
}

TEST(CutOffImages, AnImageThatIsMostlyWhiteIsExposedTooLong) {
  const auto said = [](int white) {
    vehicle::Recording recording;
    recording.sensors = [white](Time) {
      vehicle::Sensors s;
      s.camera = sensors::made<StereoPair>(
          [white, i = 0](StereoPair& pair, sensors::SourceReport&) mutable {
            pair.stamp = from_nanoseconds(++i);
            pair.left.resize(10, 10);
            std::ranges::fill(pair.left.pixels, std::uint8_t{100});
            std::fill_n(pair.left.pixels.begin(), white, std::uint8_t{255});
            return i < 4;
          });
      return s;
    };
    return cut_off_images(recording, {});
  };
  EXPECT_THAT(said(60),
              ::testing::ElementsAre(::testing::HasSubstr("60 % of the pixels of camera")));
  EXPECT_TRUE(said(10).empty());
}

}  // namespace
}  // namespace maploop::tools
