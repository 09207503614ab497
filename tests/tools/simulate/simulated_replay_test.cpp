// Tests a replay with a simulated drive's GNSS receiver.
#include <gtest/gtest.h>

#include "msgs/frames.h"
#include "runtime/vehicle/drivers/recording.h"
#include "tests/tools/simulate/made_drive.h"

namespace maploop::simulate {
namespace {

namespace fs = std::filesystem;

TEST(SimulatedReplay, ObservationsTakeThePlaceOfTheReferencesGnss) {
  SimulationOptions options;
  options.seconds = 5.0;
  options.sensors = {false, false, true, true};
  options.imu = ImuGrade::mems;
  const fs::path drive = made("replayed", options), sync = drive / "town_sync";
  // A drive can be opened if it has the stamps of images.
  for (const char* camera : {"image_00", "image_01"}) {
    fs::create_directories(sync / camera / "data");
    fs::copy_file(sync / "oxts/timestamps.txt", sync / camera / "timestamps.txt");
  }
  vehicle::VehicleConfig config = vehicle::load_vehicle_config(drive / "vehicle.toml");
  EXPECT_EQ(config.fusion.gnss_lever_up, 0.75);
  EXPECT_TRUE(fs::exists(config.map.file));
  EXPECT_EQ(config.imu_grade, "mems");
  EXPECT_EQ(config.vehicle.lidar.model, "HDL-64E");
  EXPECT_EQ(config.replay.imu_delay, 0.06);
  EXPECT_NEAR(config.lidar.elevation_correction, radians(0.205), 1e-8);
  EXPECT_EQ(config.wheel.errors, sensors::ErrorModel::drawn);
  EXPECT_EQ(config.wheel.seed, 1);
  // The configuration contains all that a recording can know about its car.
  for (const char* key : {"vehicle.rear_axle_distance", "vehicle.climb_offset",
                          "vehicle.climb_offset_sigma", "vehicle.lidar.beam_elevation"}) {
    EXPECT_TRUE(config.given.contains(key)) << key;
  }

  vehicle::fit_to_recording(config, drive / "town_extract");
  EXPECT_EQ(config.configuration, "auto") << "images and scans are in the folder beside it";
  EXPECT_EQ(config.odometry, "visual-lidar");

  const vehicle::Recording recording = vehicle::open_recording(drive / "town_extract", config);
  vehicle::Sensors sensors = recording.sensors(Time::max());
  EXPECT_EQ(sensors.gnss, nullptr);
  ASSERT_NE(sensors.epochs, nullptr);
  ASSERT_NE(sensors.ppp, nullptr);
  EXPECT_TRUE(sensors.ppp->precise());
  vehicle::GnssEpoch epoch;
  std::size_t count = 0;
  for (; sensors.epochs->next(epoch); ++count)
    EXPECT_EQ(epoch.stamp, recording.first_stamp + std::chrono::seconds(count));
  EXPECT_EQ(count, 5U);
  ASSERT_TRUE(recording.driven_links.has_value());
  EXPECT_EQ(recording.driven_links->stamps.size(), recording.images);

  config.ppp.observations = false;
  sensors = vehicle::open_recording(drive / "town_extract", config).sensors(Time::max());
  EXPECT_NE(sensors.gnss, nullptr);
  EXPECT_EQ(sensors.epochs, nullptr);
}

}  // namespace
}  // namespace maploop::simulate
