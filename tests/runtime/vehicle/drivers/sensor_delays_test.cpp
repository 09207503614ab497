// Recordings of every kind whose vehicle's file says that the stamps of its sensors are late.
#include "runtime/vehicle/drivers/sensor_delays.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "runtime/vehicle/drivers/limited_source.h"
#include "runtime/vehicle/drivers/recording.h"
#include "tests/runtime/vehicle/driven.h"
#include "tests/support/real_data.h"

namespace maploop::vehicle {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

constexpr Duration camera = milliseconds(20), lidar = milliseconds(15), imu = milliseconds(300),
                   antenna = milliseconds(100);

VehicleConfig late() {
  VehicleConfig config;
  VehicleDescription& d = config.vehicle;
  for (const auto& [time, delay] :
       {std::pair(&d.camera.time, camera), std::pair(&d.lidar.time, lidar),
        std::pair(&d.imu.time, imu), std::pair(&d.antenna.time, antenna)})
    time->delay = to_seconds(delay);
  return config;
}

template <class T>
std::vector<T> first_of(const std::unique_ptr<sensors::Source<T>>& source, std::size_t most = 4) {
  std::vector<T> samples;
  for (T sample; source != nullptr && samples.size() < most && source->next(sample);)
    samples.push_back(sample);
  return samples;
}

// Expects that the second source has the samples of the first one, measured earlier.
template <class T>
void expect_earlier(const std::unique_ptr<sensors::Source<T>>& recorded,
                    const std::unique_ptr<sensors::Source<T>>& moved, Duration by) {
  const std::vector<T> a = first_of(recorded), b = first_of(moved);
  ASSERT_FALSE(a.empty());
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(b[i].stamp, a[i].stamp - by);
    EXPECT_EQ(b[i].available, a[i].available);
    if constexpr (requires { a[i].start; }) {
      EXPECT_EQ(b[i].start, a[i].start - by);
      EXPECT_EQ(b[i].end, a[i].end - by);
    }
    if constexpr (requires { a[i].velocity_stamp; }) {
      EXPECT_EQ(b[i].velocity_stamp, a[i].velocity_stamp - by);
    }
  }
}

// Drive 0013 whose stamps of the images are earlier by `camera`, and those of the scans by `lidar`.
class ShiftedDrive {
 public:
  ShiftedDrive() {
    const fs::path from = maploop::testing::drive_0013();
    for (const auto& entry : fs::directory_iterator(from.parent_path())) {
      if (entry.is_regular_file())
        fs::create_symlink(entry.path(), folder_.path() / entry.path().filename());
    }
    fs::create_directory(path());
    fs::create_symlink(from / "oxts", path() / "oxts");
    for (const char* sensor : {"image_00", "image_01", "velodyne_points"}) {
      fs::create_directory(path() / sensor);
      fs::create_symlink(from / sensor / "data", path() / sensor / "data");
      for (const auto& entry : fs::directory_iterator(from / sensor)) {
        if (entry.is_regular_file())
          shift(entry.path(), path() / sensor, sensor[0] == 'i' ? camera : lidar);
      }
    }
  }
  fs::path path() const { return folder_.path() / "2011_09_26_drive_0013_sync"; }

 private:
  static void shift(const fs::path& stamps, const fs::path& to, Duration by) {
    std::ifstream in(stamps);
    std::ofstream out(to / stamps.filename());
    for (std::string line; std::getline(in, line);)
      out << format_time(parse_time(line) - by) << '\n';
  }

  maploop::testing::TemporaryFolder folder_;
};

TEST(SensorDelays, AKittiDriveIsThatOfShiftedStamps) {
  MAPLOOP_REQUIRE_DRIVE();
  const Recording plain = open_recording(maploop::testing::drive_0013(), {}),
                  moved = open_recording(maploop::testing::drive_0013(), late());
  const Sensors a = plain.sensors(Time::max()), b = moved.sensors(Time::max());
  expect_earlier(a.camera, b.camera, camera);
  expect_earlier(a.velodyne, b.velodyne, lidar);
  expect_earlier(a.gnss, b.gnss, antenna);
  expect_earlier(a.imu, b.imu, {});  // [vehicle.imu] delay is what the reader of rows takes off
  const ShiftedDrive shifted;
  const Sensors c = open_recording(shifted.path(), {}).sensors(Time::max());
  const auto of_delay = first_of(moved.sensors(Time::max()).camera), of_stamps = first_of(c.camera);
  ASSERT_EQ(of_stamps.size(), 4U);
  for (std::size_t i = 0; i < of_stamps.size(); ++i)
    EXPECT_EQ(of_delay[i].stamp, of_stamps[i].stamp);
  if (plain.driven_links) {
    EXPECT_EQ(moved.driven_links->stamps.at(0), plain.driven_links->stamps.at(0) - camera);
  }
}

// A delay does not change when an image comes, which the readout says of a drive of shifted stamps.
TEST(SensorDelays, ADelayGivesTheBitsOfShiftedStamps) {
  MAPLOOP_REQUIRE_DRIVE();
  const ShiftedDrive shifted;
  const auto states = [](const fs::path& path, VehicleConfig config) {
    Recording recording = open_recording(path, config);
    testing::Drive d{.sensors = recording.sensors(Time::min()), .config = std::move(config)};
    d.sensors.velodyne = nullptr;
    limit(d.sensors, parse_time("2011-09-26 13:10:54"));
    d.calibration = recording.calibration;
    return testing::drive(std::move(d)).hashes().at("NAV_STATE");
  };
  VehicleConfig delayed, later;
  delayed.vehicle.camera.time.delay = to_seconds(camera);
  later.replay.camera_readout += to_seconds(camera);
  const std::string of_delay = states(maploop::testing::drive_0013(), delayed);
  EXPECT_EQ(of_delay, states(shifted.path(), later));
  EXPECT_NE(of_delay, states(maploop::testing::drive_0013(), {}));
}

TEST(SensorDelays, ABagsStampsAreMovedInTheSameWay) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const fs::path bag = maploop::testing::real_data() / "bags/kitti_0013/kitti13_zstd.mcap";
  const Sensors a = open_recording(bag, {}).sensors(Time::max()),
                b = open_recording(bag, late()).sensors(Time::max());
  expect_earlier(a.camera, b.camera, camera);
  expect_earlier(a.velodyne, b.velodyne, lidar);
  expect_earlier(a.gnss, b.gnss, antenna);
  expect_earlier(a.imu, b.imu, imu);
}

TEST(SensorDelays, TablesAreMovedWithTheFixesThatScoreThem) {
  const maploop::testing::TemporaryFolder folder;
  std::ofstream(folder.path() / "gnss.csv")
      << "t_s,lat_deg,lon_deg,height_m,vn_mps,ve_mps,vd_mps,pos_std_n_m,pos_std_e_m,pos_std_d_m,"
         "vel_std_n_mps,vel_std_e_mps,vel_std_d_mps\n"
         "0,43.5,-79.7,100,5,0,0,0.4,0.5,0.6,0.1,0.2,0.3\n"
         "1,43.5,-79.7,100,5,0,0,0.4,0.5,0.6,0.1,0.2,0.3\n";
  std::ofstream(folder.path() / "imu.csv")
      << "t_s,gx_radps,gy_radps,gz_radps,ax_mps2,ay_mps2,az_mps2\n0,0,0,0,0,0,9.8\n";
  const auto open = [&](VehicleConfig config) {
    set_configuration(config, "GNSS+RI");
    config.given.insert("vehicle.imu.yaw");
    return open_recording(folder.path(), config);
  };
  const Recording recorded = open({}), moved = open(late());
  const Sensors a = recorded.sensors(Time::min()), b = moved.sensors(Time::min());
  expect_earlier(a.gnss, b.gnss, antenna);
  expect_earlier(a.imu, b.imu, imu);
  expect_earlier(recorded.fixes(), moved.fixes(), antenna);
}

TEST(SensorDelays, ALogsStampsAreTakenAsTheyAre) {
  const fs::path log = maploop::testing::source("tests/fuzz/corpus/recording/sensors.lcmlog");
  const Sensors a = open_recording(log, {}).sensors(Time::min()),
                b = open_recording(log, late()).sensors(Time::min());
  expect_earlier(a.camera, b.camera, {});
  expect_earlier(a.velodyne, b.velodyne, {});
  expect_earlier(a.imu, b.imu, {});
}

TEST(SensorDelays, TheMountIsFoundFromFixesOnTheClockOfTheUnit) {
  static constexpr Time start = from_nanoseconds(1'000'000'000'000);
  auto fixes = sensors::made<GnssFix>([n = 0](GnssFix& fix, sensors::SourceReport&) mutable {
    fix.stamp = fix.velocity_stamp = fix.available = start + std::chrono::seconds(n);
    return n++ < 4;
  });
  const std::vector<GnssOutage> outages{
      {start + milliseconds(850), start + milliseconds(950)}};  // the second one is measured there
  const auto there = first_of(on_the_units_clock(std::move(fixes), outages, delays_of(late())));
  ASSERT_EQ(there.size(), 3U);
  EXPECT_EQ(there[0].stamp, start - antenna + imu);
  EXPECT_EQ(there[1].stamp, start + std::chrono::seconds(2) - antenna + imu);
}

}  // namespace
}  // namespace maploop::vehicle
