// These tests open folders of other data sets, and tables whose columns a file names.
#include "runtime/vehicle/drivers/folder_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "runtime/core/config.h"
#include "runtime/vehicle/drivers/table_drive.h"
#include "sensors/image/png.h"
#include "tests/support/error_of.h"
#include "tests/support/real_data.h"

namespace maploop::vehicle {
namespace {

namespace fs = std::filesystem;
using maploop::testing::error_of;
using ::testing::AllOf;
using ::testing::HasSubstr;

class Folders : public ::testing::Test {
 protected:
  void write(const fs::path& name, const std::string& text) const {
    fs::create_directories((folder() / name).parent_path());
    std::ofstream(folder() / name, std::ios::binary) << text;
  }
  void image(const fs::path& name) const {
    const auto png = sensors::encode_png(std::vector<std::uint8_t>(32 * 24, 7), 32, 24);
    write(name, {png.begin(), png.end()});
  }
  std::string refusal() const {
    return error_of([&] { open_recording(folder(), config_); });
  }
  fs::path folder() const { return folder_.path(); }

  maploop::testing::TemporaryFolder folder_;
  VehicleConfig config_;
};

constexpr const char* mapping =
    "[imu]\nfile = \"imu.csv\"\ntime = \"t [ms]\"\ntime_unit = \"ms\"\ngyro = [\"gx\", \"gy\", "
    "\"gz\"]\ngyro_unit = \"deg/s\"\naccelerometer = [\"ax\", \"ay\", \"az\"]\n"
    "accelerometer_unit = \"g\"\n[gnss]\nfile = \"fixes.csv\"\ntime = \"s\"\nposition = [\"lat\", "
    "\"lon\", \"h\"]\n";

TEST_F(Folders, TablesAreWhatTheirFileSays) {
  write("maploop.tables.toml", mapping);
  write("imu.csv", "t [ms],gx,gy,gz,ax,ay,az\n1600000000010,0,0,90,0,0,1\n");
  write("fixes.csv", "s,lat,lon,h\n1600000000,49,8,100\n1600000001,49,8,100\n");
  fit_to_recording(config_, folder());
  EXPECT_EQ(config_.configuration, "GNSS+RI");
  EXPECT_EQ(config_.imu_grade, "mems");
  config_.given.insert("vehicle.imu.yaw");
  const Recording recording = open_recording(folder(), config_);
  EXPECT_EQ(recording.images, 2U);
  EXPECT_EQ(recording.first_stamp, parse_time("2020-09-13 12:26:40"));
  const Sensors s = recording.sensors(Time::min());
  ASSERT_TRUE(s.imu != nullptr && s.gnss != nullptr);
  EXPECT_TRUE(s.camera == nullptr && s.wheel == nullptr && s.reference == nullptr);
}

TEST_F(Folders, WhatIsWrongInTheFileOfTablesIsNamedWithItsKey) {
  struct Case {
    const char *text, *says;
  };
  for (const Case& c : std::initializer_list<Case>{
           {"[imu]\nfile = \"imu.csv\"\n", "imu.gyro"},
           {"[imu]\nfile = \"imu.csv\"\ngyro = [\"x\"]\n", "must name 3 columns"},
           {"[imu]\nfile = \"imu.csv\"\ngyro = [\"x\", \"y\", \"z\"]\ngyro_unit = \"rpm\"\n",
            "gyro_unit"},
           {"[gnss]\nfile = \"f.csv\"\ntime_unit = \"h\"\n", "time_unit"},
           {"[gnss]\nfile = \"f.csv\"\nposition = [\"a\", \"b\", \"c\"]\nposition_sigma_m = -1.0\n",
            "position_sigma_m"},
           {"[gnss]\nfiel = \"f.csv\"\n", "fiel"},
           {"[wheel]\nfile = \"f.csv\"\n", "wheel.speed"},
           {"[reference]\nfile = \"f.csv\"\nposition = [\"a\", \"b\", \"c\"]\n", "quaternion"}}) {
    write("maploop.tables.toml", c.text);
    EXPECT_THAT(refusal(), AllOf(HasSubstr("maploop.tables.toml"), HasSubstr(c.says))) << c.text;
  }
  write("maploop.tables.toml", "");
  EXPECT_THAT(refusal(), HasSubstr("needs the fixes of a GNSS receiver"));
}

TEST_F(Folders, WheelsAndAnInertialUnitAreRunAsRiss) {
  write("maploop.tables.toml", std::string(mapping) +
                                   "[wheel]\nfile = \"odo.csv\"\ntime = \"s\"\nspeed = \"v\"\n"
                                   "speed_unit = \"km/h\"\n");
  write("imu.csv", "t [ms],gx,gy,gz,ax,ay,az\n1600000000010,0,0,90,0,0,1\n");
  write("fixes.csv", "s,lat,lon,h\n1600000000,49,8,100\n");
  write("odo.csv", "s,v\n1600000000,36\n");
  fit_to_recording(config_, folder());
  EXPECT_EQ(config_.configuration, "GNSS+RISS");
  const Sensors s = open_recording(folder(), config_).sensors(Time::min());
  WheelSpeed speed;
  ASSERT_TRUE(s.wheel->next(speed));
  EXPECT_DOUBLE_EQ(speed.speed, 10.0);
}

TEST_F(Folders, ASolutionOfRtklibIsADriveInUtc) {
  write("rover.pos",
        "%  GPST latitude(deg) longitude(deg) height(m) Q ns sdn(m) sde(m) sdu(m)\n"
        "2019/06/08 08:03:55.500 47.06 -1.35 84.86 1 7 0.01 0.02 0.03\n"
        "2019/06/08 08:03:56.500 47.06 -1.35 84.86 0 7 0.01 0.02 0.03\n");
  const Recording recording = open_recording(folder() / "rover.pos", config_);
  EXPECT_EQ(recording.first_stamp, parse_time("2019-06-08 08:03:37.5"));
  const auto gnss = recording.sensors(Time::min()).gnss;
  GnssFix fix;
  ASSERT_TRUE(gnss->next(fix));
  EXPECT_NEAR(fix.position_covariance(0, 0), 4e-4, 1e-12);  // east
  EXPECT_FALSE(gnss->next(fix)) << "its quality is 0";
}

TEST_F(Folders, ImagesNeedTheirCalibrationUnlessThereAreClouds) {
  for (const char* name : {"cam0/1.0.png", "cam0/1.1.png", "cam1/1.0.png", "cam1/1.1.png"})
    image(name);
  EXPECT_THAT(refusal(), AllOf(HasSubstr(folder()), HasSubstr("[vehicle.camera] calibration")));
  write("lidar/1.0.bin", std::string(16, '\0'));
  const Recording clouds = open_recording(folder(), config_);
  EXPECT_EQ(clouds.sensors(Time::min()).camera, nullptr);
  EXPECT_EQ(clouds.images, 1U);
  ASSERT_EQ(clouds.notes.size(), 1U);
  EXPECT_THAT(clouds.notes[0], HasSubstr("Not used"));
  CameraDescription& camera = config_.vehicle.camera;
  camera.width = 32;
  camera.height = 24;
  camera.fx = camera.fy = 30.0;
  camera.baseline = 0.5;
  for (const char* key : {"width", "height", "fx", "fy", "cx", "cy", "baseline"})
    config_.given.insert(std::string("vehicle.camera.") + key);
  const Recording recording = open_recording(folder(), config_);
  EXPECT_EQ(recording.images, 2U);
  StereoPair pair;
  ASSERT_TRUE(recording.sensors(Time::min()).camera->next(pair));
  EXPECT_EQ(pair.left.pixels.at(0), 7);
}

TEST_F(Folders, OxtsRowsAloneAreRunAsRissWithTheirOwnGrade) {
  fs::create_directories(folder() / "oxts/data");
  fit_to_recording(config_, folder());
  EXPECT_EQ(config_.configuration, "GNSS+RISS");
  EXPECT_EQ(config_.imu_grade, "tactical");
}

TEST_F(Folders, CloudsAloneAreADriveOfAnAssumedRate) {
  for (const char* name : {"000000.bin", "000001.bin"}) write(name, std::string(16, '\0'));
  const Recording recording = open_recording(folder(), config_);
  EXPECT_EQ(recording.images, 2U);
  ASSERT_EQ(recording.notes.size(), 1U);
  EXPECT_THAT(recording.notes[0], HasSubstr("0.1 s apart"));
}

}  // namespace
}  // namespace maploop::vehicle
