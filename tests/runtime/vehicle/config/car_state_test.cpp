// Tests the file in which a car's estimated properties are kept.
#include "runtime/vehicle/config/car_state.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/error_of.h"
#include "tests/support/real_data.h"

namespace maploop::vehicle {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

// Returns properties whose values are their numbers; the even ones are observed.
fusion::SelfCalibrations estimated() {
  fusion::SelfCalibrations all = fusion::self_calibrations({}, fusion::StateVector::Zero());
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].value = 0.1 + static_cast<double>(i);
    all[i].sigma = i % 2 == 0 ? 0.3 : 0.9;
    all[i].sigma_at_start = 1.0;
  }
  return all;
}

class CarState : public ::testing::Test {
 protected:
  std::filesystem::path file() const { return folder_.path() / "maploop.state"; }

  void write(const std::string& text) const { std::ofstream(file()) << text; }

  std::string error(const std::string& car = "golf") const {
    return maploop::testing::error_of([&] { read_car_state(file(), car); });
  }

  maploop::testing::TemporaryFolder folder_;
  const Time at_ = parse_time("2011-09-26 13:02:47.5");
};

TEST_F(CarState, WhatWasObservedComesBackToTheBit) {
  EXPECT_FALSE(read_car_state(file(), "golf").has_value()) << "there is no file yet";
  EXPECT_EQ(write_car_state(file(), "golf", at_, estimated()), (fusion::calibrated_count + 1) / 2);
  const auto known = read_car_state(file(), "golf");
  ASSERT_TRUE(known.has_value());
  EXPECT_EQ(known->at, at_);
  for (std::size_t i = 0; i < fusion::calibrated_count; ++i) {
    EXPECT_EQ(known->value[i], i % 2 == 0 ? 0.1 + static_cast<double>(i) : 0.0) << i;
    EXPECT_EQ(known->sigma[i], i % 2 == 0 ? 0.3 : 0.0) << i;
  }
}

TEST_F(CarState, ANewEstimateTakesTheOldOnesPlaceUnlessNothingWasObserved) {
  write_car_state(file(), "golf", at_, estimated());
  EXPECT_EQ(write_car_state(file(), "golf", at_,
                            fusion::self_calibrations({}, fusion::StateVector::Zero())),
            0u);
  EXPECT_TRUE(read_car_state(file(), "golf").has_value());
  fusion::SelfCalibrations other = estimated();
  other[0].value = 7.0;
  write_car_state(file(), "golf", at_, other);
  EXPECT_EQ(read_car_state(file(), "golf")->value[0], 7.0);
}

TEST_F(CarState, AnotherCarsFileIsRefused) {
  write_car_state(file(), "a \"red\" bus", at_, estimated());
  EXPECT_TRUE(read_car_state(file(), "a \"red\" bus").has_value());
  EXPECT_THAT(error(), AllOf(HasSubstr("maploop.state:2"), HasSubstr("red"), HasSubstr("--state")));
}

TEST_F(CarState, DamagedFilesAreRefusedWithTheirPlace) {
  const std::string head = "car = \"golf\"\nat = \"2011-09-26 13:02:47.5\"\n";
  for (const auto& [text, says] : std::vector<std::pair<std::string, std::string>>{
           {"car = ", "maploop.state:1"},
           {"car = \"golf\"\nat = \"noon\"\n", "maploop.state:2"},
           {"car = \"golf\"\n", "at"},
           {head + "[axle_distance]\nvalue = 1.0\nsigma = 0.0\nunit = \"m\"\n", "sigma"},
           {head + "[axle_distance]\nvalue = 1.0\nunit = \"m\"\n", "sigma"},
           {head + "[axle_distance]\nsigma = 0.1\nunit = \"m\"\n", "value"},
           {head + "[axle_distance]\nvalue = nan\nsigma = 0.1\nunit = \"m\"\n", "value"},
           {head + "[axle_distance]\nvalue = 1.0\nsigma = 0.1\nunit = \"cm\"\n", "unit"},
           {head + "[axle_length]\nvalue = 1.0\n", "axle_length"}}) {
    write(text);
    EXPECT_THAT(error(), HasSubstr(says)) << text;
  }
}

}  // namespace
}  // namespace maploop::vehicle
