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

class CarStateFile : public ::testing::Test {
 protected:
  std::filesystem::path file() const { return folder_.path() / "maploop.state"; }

  CarEstimate learnt() const { return {at_, estimated(), {}, {}}; }

  void write(const std::string& text) const { std::ofstream(file()) << text; }

  std::string error(const std::string& car = "golf") const {
    return maploop::testing::error_of([&] { read_car_state(file(), car); });
  }

  maploop::testing::TemporaryFolder folder_;
  const Time at_ = parse_time("2011-09-26 13:02:47.5");
};

TEST_F(CarStateFile, WhatWasObservedComesBackToTheBit) {
  EXPECT_FALSE(read_car_state(file(), "golf").has_value()) << "there is no file yet";
  EXPECT_EQ(write_car_state(file(), "golf", learnt()), (fusion::calibrated_count + 1) / 2);
  const auto known = read_car_state(file(), "golf");
  ASSERT_TRUE(known.has_value());
  EXPECT_FALSE(known->place);
  EXPECT_EQ(known->calibration.at, at_);
  for (std::size_t i = 0; i < fusion::calibrated_count; ++i) {
    EXPECT_EQ(known->calibration.value[i], i % 2 == 0 ? 0.1 + static_cast<double>(i) : 0.0) << i;
    EXPECT_EQ(known->calibration.sigma[i], i % 2 == 0 ? 0.3 : 0.0) << i;
  }
}

TEST_F(CarStateFile, ANewEstimateTakesTheOldOnesPlaceUnlessNothingWasObserved) {
  write_car_state(file(), "golf", learnt());
  CarEstimate nothing{at_, fusion::self_calibrations({}, fusion::StateVector::Zero()), {}, {}};
  EXPECT_EQ(write_car_state(file(), "golf", nothing), 0u);
  EXPECT_TRUE(read_car_state(file(), "golf").has_value());
  CarEstimate other = learnt();
  other.calibration[0].value = 7.0;
  write_car_state(file(), "golf", other);
  EXPECT_EQ(read_car_state(file(), "golf")->calibration.value[0], 7.0);
}

TEST_F(CarStateFile, WhatTheDriveBeganWithIsKeptWhereItHasNotObservedIt) {
  CarEstimate short_drive = learnt();
  short_drive.before.sigma[1] = 0.5;
  EXPECT_EQ(write_car_state(file(), "golf", short_drive), (fusion::calibrated_count + 1) / 2 + 1);
  EXPECT_EQ(read_car_state(file(), "golf")->calibration.value[1], 1.1);
}

TEST_F(CarStateFile, ThePlaceComesBack) {
  CarEstimate estimate;
  estimate.at = at_;
  estimate.place = {at_,
                    {0.8550, -0.1466, 110.25},
                    {-2.5, 0.03, -0.02},
                    -1.25,
                    {1.5, 1.25, 2.5},
                    0.01,
                    0.02,
                    0.3,
                    {0.5, -0.5, 0.25},
                    {0.75, 1.0, 0.5},
                    {-0.75, -0.5, 0.0}};
  EXPECT_EQ(write_car_state(file(), "golf", estimate), 1u);
  const auto known = read_car_state(file(), "golf");
  ASSERT_TRUE(known && known->place);
  const fusion::LastPlace &wrote = *estimate.place, &read = *known->place;
  EXPECT_EQ(read.stamp, wrote.stamp);
  EXPECT_NEAR(read.position.latitude, wrote.position.latitude, 1e-15);
  EXPECT_NEAR(read.position.longitude, wrote.position.longitude, 1e-15);
  EXPECT_EQ(read.position.height, wrote.position.height);
  EXPECT_NEAR(read.attitude.azimuth, wrote.attitude.azimuth, 1e-14);
  EXPECT_NEAR(read.attitude.pitch, wrote.attitude.pitch, 1e-15);
  EXPECT_NEAR(read.attitude.roll, wrote.attitude.roll, 1e-15);
  EXPECT_EQ(read.speed, wrote.speed);
  EXPECT_EQ(read.position_sigma, wrote.position_sigma);
  EXPECT_EQ(read.fix_offset, wrote.fix_offset);
  EXPECT_EQ(read.fix_offset_sigma, wrote.fix_offset_sigma);
  EXPECT_EQ(read.fix_offset_correlation, wrote.fix_offset_correlation);
  EXPECT_NEAR(read.azimuth_sigma, wrote.azimuth_sigma, 1e-15);
  EXPECT_NEAR(read.tilt_sigma, wrote.tilt_sigma, 1e-15);
  EXPECT_EQ(read.speed_sigma, wrote.speed_sigma);
}

TEST_F(CarStateFile, AFileThatWasCutOrEditedIsRefused) {
  CarEstimate estimate = learnt();
  estimate.place.emplace().stamp = at_;
  write_car_state(file(), "golf", estimate);
  std::ifstream stream(file());
  const std::string whole(std::istreambuf_iterator<char>(stream), {});
  ASSERT_TRUE(read_car_state(file(), "golf").has_value());
  for (const std::size_t length : {whole.size() - 1, whole.size() - 30, whole.size() / 2}) {
    write(whole.substr(0, length));
    EXPECT_NE(error(), "") << length;
  }
  std::string edited = whole;
  edited.replace(edited.find("height = 0"), 10, "height = 9");
  write(edited);
  EXPECT_THAT(error(), AllOf(HasSubstr("maploop.state:2"), HasSubstr("edited")));
  write("version = 3\n");
  EXPECT_THAT(error(), HasSubstr("is 3, but this program reads 1 to 2"));
}

TEST_F(CarStateFile, AnotherCarsFileIsRefused) {
  write_car_state(file(), "a \"red\" bus", learnt());
  EXPECT_TRUE(read_car_state(file(), "a \"red\" bus").has_value());
  EXPECT_THAT(error(), AllOf(HasSubstr("maploop.state"), HasSubstr("red"), HasSubstr("--state")));
}

TEST_F(CarStateFile, DamagedFilesAreRefusedWithTheirPlace) {
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
