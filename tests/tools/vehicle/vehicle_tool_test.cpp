#include "tools/vehicle/vehicle_tool.h"

#include <expat.h>
#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <sstream>

#include "tests/support/error_of.h"
#include "tests/support/real_data.h"

namespace maploop::vehicle_tool {
namespace {

using ::testing::AllOf;
using testing::error_of;
using ::testing::HasSubstr;
using ::testing::Not;

vehicle::VehicleConfig load(const std::string& text) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "car.toml";
  std::ofstream(file) << text;
  return vehicle::load_vehicle_config(file);
}

// A description whose every number differs from its default, and is in its range.
VehicleDescription odd_description() {
  VehicleDescription d;
  double step = 0.0;
  each_table(
      [&](const auto& table, auto& values) {
        for (const auto& parameter : table.parameters) {
          ParameterValue value = parameter.value_in(values);
          step += 1.0 / 3.0;
          if (double* number = std::get_if<double>(&value))
            *number += (parameter.most - *number) * step / 100.0;
          parameter.set(values, value);
        }
      },
      d);
  d.car.side_of_road = RoadSide::left;
  d.camera.width = 640;
  d.camera.height = 480;
  d.lidar.model = "HDL-32E";
  return d;
}

TEST(VehicleDescription, WhatIsWrittenIsReadBack) {
  const VehicleDescription written = odd_description();
  const VehicleDescription read = load(to_toml(written)).vehicle;
  each_table(
      [&](const auto& table, const auto& own, const auto& other) {
        for (const auto& parameter : table.parameters) {
          EXPECT_EQ(parameter.value_in(own), parameter.value_in(other))
              << table.name << '.' << parameter.key;
        }
      },
      written, read);
  EXPECT_EQ(to_toml(VehicleDescription{}), "");
}

TEST(VehicleDescription, AnglesAreThoseOfTheRotationEvenStraightUp) {
  for (const double pitch : {-90.0, -30.0, 0.0, 89.9, 90.0}) {
    for (const double roll : {-170.0, 0.0, 20.0, 180.0}) {
      const Eigen::Isometry3d T = camera_pose({1.0, 2.0, 3.0}, {roll, pitch, 70.0});
      SensorPosition position;
      SensorRotation rotation;
      set_camera_pose(T, position, rotation);
      EXPECT_TRUE(camera_pose(position, rotation).isApprox(T, 1e-12)) << pitch << ' ' << roll;
    }
  }
  // To the left, then nose up.
  const Eigen::Vector3d forward = sensor_pose({}, {0.0, 30.0, 90.0}) * Eigen::Vector3d::UnitX();
  EXPECT_TRUE(forward.isApprox(Eigen::Vector3d(0.0, std::sqrt(0.75), 0.5), 1e-12));
  EXPECT_TRUE(camera_pose({}, {}).linear().col(2).isApprox(Eigen::Vector3d::UnitX()));
}

// The last answers about a car without sensors, after seven about the car itself.
const std::string no_sensors = "n\nn\nn\nn\n";

TEST(Questions, AnswersAreWrittenWithTheirStandardDeviation) {
  std::istringstream in("golf\nleft\n1.2 0.1\n\n0.33\n\n0.01 0.002\n\n" + no_sensors);
  std::ostringstream out;
  const VehicleDescription d = ask(in, out);
  EXPECT_EQ(d.car.name, "golf");
  EXPECT_EQ(d.car.side_of_road, RoadSide::left);
  EXPECT_EQ(d.car.rear_axle_distance, 1.2);
  EXPECT_EQ(d.car.rear_axle_distance_sigma, 0.1);
  EXPECT_EQ(d.car.rear_axle_height, 0.0);
  EXPECT_EQ(d.car.wheel_radius, 0.33);
  EXPECT_EQ(d.car.climb_offset_sigma, 0.002);
  EXPECT_THAT(out.str(), HasSubstr("Radius of a rear wheel"));
}

TEST(Questions, AWrongAnswerIsAskedForAgain) {
  std::istringstream in("\nmiddle\nright\n99\n1.2 -1\nfar\n1.2\n\n\n\n\n\n" + no_sensors);
  std::ostringstream out;
  const VehicleDescription d = ask(in, out);
  EXPECT_EQ(d.car.rear_axle_distance, 1.2);
  EXPECT_EQ(d.car.rear_axle_distance_sigma, 1.0);
  EXPECT_THAT(
      out.str(),
      AllOf(HasSubstr("side_of_road is \"middle\"; allowed is \"by-map\", \"right\", \"left\""),
            HasSubstr("rear_axle_distance is 99; allowed is -5 to 5 m"),
            HasSubstr("rear_axle_distance_sigma is -1; allowed is above 0"),
            HasSubstr("rear_axle_distance is not a number: 'far'")));
}

TEST(Questions, OnlyTheSensorsThatAreThereAreAskedFor) {
  std::istringstream in(
      "\n\n\n\n\n\n\n\nn\nperhaps\ny\nHDL-32E\n\n\n0.5 0.01\n\n1.5 0.01\n\n\n\n\nn\nn\n");
  std::ostringstream out;
  const VehicleDescription d = ask(in, out);
  EXPECT_EQ(d.lidar.model, "HDL-32E");
  EXPECT_EQ(d.lidar.position.up, 1.5);
  EXPECT_THAT(out.str(), Not(HasSubstr("baseline")));
  std::istringstream ends("\nright\n1.0\n");
  EXPECT_THAT(error_of([&] { ask(ends, out); }),
              HasSubstr("the answers end before 'rear_axle_height' of [vehicle]"));
}

TEST(Check, SaysWhatIsImplausible) {
  const std::pair<const char*, const char*> odd[] = {
      {"[vehicle.antenna]\nforward = 7.0\n", "[vehicle.antenna] is outside of a passenger car"},
      {"[vehicle.camera]\nyaw = 180.0\n", "[vehicle.camera] looks backwards"},
      {"[vehicle.camera]\nroll = 180.0\n", "[vehicle.camera] is upside down"},
      {"[vehicle.lidar]\nroll = 170.0\n", "[vehicle.lidar] is upside down"},
      {"[vehicle.imu]\nyaw = 90.0\n",
       "[vehicle.imu] is turned by more than 10 deg: samples of a drive of tables (imu.csv) are "
       "turned into the body's axes by it, those of any other unit are not"},
      {"[vehicle.lidar]\nup = 1.0\n", "up is given without up_sigma: 1.0 m is assumed"},
      {"[vehicle.camera]\nup = 1.0\n", "has neither a calibration nor the intrinsics"},
  };
  for (const auto& [text, said] : odd) {
    std::string all;
    for (const std::string& warning : look_at(load(text)).warnings) all += warning + '\n';
    EXPECT_THAT(all, HasSubstr(said));
  }
  EXPECT_THAT(error_of([] { look_at(load("[vehicle.camera]\ncalibration = \"no.toml\"\n")); }),
              HasSubstr("no.toml"));
  EXPECT_THAT(error_of([] {
                look_at(load("[vehicle.lidar]\nmodel = \"HDL-64E\"\ncalibration = \"no.xml\"\n"));
              }),
              HasSubstr("no.xml"));
}

TEST(Check, ListsWhatIsAssumed) {
  EXPECT_TRUE(look_at(load(to_toml(odd_description()))).assumed.empty());
  const Findings found = look_at(load("[vehicle]\ntrack = 1.6\ntrack_sigma = 0.01\n"));
  EXPECT_TRUE(found.warnings.empty());
  ASSERT_EQ(found.assumed.size(), 5U);
  EXPECT_THAT(found.assumed[0], AllOf(HasSubstr("[vehicle] rear_axle_distance 0.0 +-1.0 m, "),
                                      Not(HasSubstr("track"))));
  EXPECT_THAT(found.assumed[4], HasSubstr("[vehicle.antenna] forward 0.0 +-1.0 m"));
}

bool parses_as_xml(const std::string& text) {
  const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(
      XML_ParserCreate(nullptr), XML_ParserFree);
  return XML_Parse(parser.get(), text.data(), static_cast<int>(text.size()), 1) == XML_STATUS_OK;
}

TEST(Drawing, ShowsWhatIsDescribedAsXml) {
  const std::string all = drawing(load(to_toml(odd_description())));
  EXPECT_TRUE(parses_as_xml(all));
  EXPECT_THAT(all, AllOf(HasSubstr("from above"), HasSubstr("from the right side"),
                         HasSubstr("camera"), HasSubstr("LiDAR"), HasSubstr("antenna"),
                         HasSubstr("rear axle"), HasSubstr("<ellipse"), Not(HasSubstr("nan"))));
  const std::string bare = drawing(load(""));
  EXPECT_TRUE(parses_as_xml(bare));
  EXPECT_THAT(bare, Not(HasSubstr("camera")));
}

}  // namespace
}  // namespace maploop::vehicle_tool
