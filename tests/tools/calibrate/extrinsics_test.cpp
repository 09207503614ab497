// Tests what is found of a vehicle whose sensors move in a known way.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "msgs/frames.h"
#include "tests/tools/calibrate/made_motion.h"
#include "tools/calibrate/extrinsics/extrinsics.h"

namespace maploop::extrinsics {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

constexpr double axle = 1.5;

VehicleDescription true_car() {
  VehicleDescription d;
  d.car.rear_axle_distance = axle;
  d.car.rear_axle_distance_sigma = 0.02;
  d.car.climb_offset_sigma = 0.005;
  d.car.rear_slip = 0.0;
  d.camera.position = {1.2, 0.3, 0.6, 0.02, 0.02, 0.02};
  d.camera.rotation = {1.0, -2.0, 0.5, 3.0, 3.0, 3.0};
  d.lidar.position = {0.4, -0.1, 0.9, 1.0, 1.0, 1.0};
  d.lidar.rotation = {-0.5, 0.8, 2.0, 3.0, 3.0, 3.0};
  d.imu.time.delay = 0.03;
  d.lidar.time.delay = 0.015;
  return d;
}

// Returns what the sensors of that car measure if their stamps are not corrected.
Measurements measured(const MadeMotion& motion) {
  const VehicleDescription d = true_car();
  Measurements m;
  m.camera.motions =
      motion.of_sensor(camera_pose(d.camera.position, d.camera.rotation), 0.0, 1e-4, 0.002, 1);
  m.lidar.motions =
      motion.of_sensor(sensor_pose(d.lidar.position, d.lidar.rotation), 0.015, 1e-4, 0.002, 2);
  m.camera.samples = static_cast<int>(m.camera.motions.size());
  m.lidar.samples = static_cast<int>(m.lidar.motions.size());
  m.inertial.samples = motion.of_gyros(0.03, 1e-4);
  return m;
}

// Turned by 5 degrees, no delays, and a LiDAR at the body's origin.
VehicleDescription wrong_car() {
  VehicleDescription d = true_car();
  for (SensorRotation* r : {&d.camera.rotation, &d.lidar.rotation}) {
    r->roll += 2.9;
    r->pitch -= 2.9;
    r->yaw += 2.9;
  }
  d.lidar.position = {};
  d.imu.time = d.lidar.time = {};
  return d;
}

const FoundValue& value(const Extrinsics& found, const std::string& table, const std::string& key) {
  const auto at = std::ranges::find_if(found.values, [&](const FoundValue& v) {
    return v.table == "vehicle." + table && v.key == key;
  });
  if (at == found.values.end()) throw std::runtime_error("not found: " + table + "." + key);
  return *at;
}

void expect(const Extrinsics& found, const std::string& table, const std::string& key, double truth,
            double tolerance) {
  const FoundValue& v = value(found, table, key);
  EXPECT_TRUE(v.observed) << table << '.' << key << " +-" << v.sigma;
  EXPECT_NEAR(v.value, truth, tolerance) << table << '.' << key << " +-" << v.sigma;
  EXPECT_LT(std::abs(v.value - truth), 4.0 * v.sigma) << table << '.' << key;
}

TEST(Extrinsics, AllIsFoundOnADriveWithTurns) {
  const Extrinsics found =
      find_extrinsics(measured(MadeMotion({.turns = 0.6, .axle = axle})), wrong_car());
  expect(found, "camera", "roll", 1.0, 0.2);
  expect(found, "camera", "pitch", -2.0, 0.2);
  expect(found, "camera", "yaw", 0.5, 0.3);
  expect(found, "lidar", "roll", -0.5, 0.2);
  expect(found, "lidar", "pitch", 0.8, 0.2);
  expect(found, "lidar", "yaw", 2.0, 0.3);
  expect(found, "imu", "delay", 0.03, 0.003);
  expect(found, "lidar", "delay", 0.015, 0.003);
  expect(found, "camera", "forward", 1.2, 0.1);
  expect(found, "lidar", "forward", 0.4, 0.1);
  expect(found, "lidar", "left", -0.1, 0.1);
  EXPECT_LT(found.contradiction, 3.0);
  const VehicleDescription& d = found.description;
  EXPECT_EQ(d.lidar.rotation.yaw, value(found, "lidar", "yaw").value);
  EXPECT_EQ(d.lidar.rotation.yaw_sigma, value(found, "lidar", "yaw").sigma);
}

TEST(Extrinsics, HeightIsNotObservableWhereTheCarTurnsAboutTheVertical) {
  const Extrinsics found = find_extrinsics(
      measured(MadeMotion({.pitches = 0.0, .rolls = 0.0, .axle = axle})), wrong_car());
  EXPECT_FALSE(value(found, "lidar", "up").observed);
  EXPECT_EQ(found.description.lidar.position.up, wrong_car().lidar.position.up) << "not written";
  EXPECT_THAT(found.sentences,
              Contains(HasSubstr("The up of [vehicle.lidar] is not observable on this recording")));
}

TEST(Extrinsics, NoTurnNoPlace) {
  const Extrinsics found =
      find_extrinsics(measured(MadeMotion({.turns = 0.002, .axle = axle})), wrong_car());
  for (const auto& [table, key] :
       {std::pair("camera", "forward"), {"lidar", "forward"}, {"lidar", "left"}, {"lidar", "up"}}) {
    EXPECT_FALSE(value(found, table, key).observed) << table << '.' << key;
  }
  expect(found, "camera", "yaw", 0.5, 0.5);
}

TEST(Extrinsics, AStraightSmoothDriveShowsNothingAndSaysSo) {
  const Extrinsics found = find_extrinsics(
      measured(MadeMotion({.turns = 0.0, .pitches = 0.0, .rolls = 0.0})), wrong_car());
  EXPECT_TRUE(found.values.empty());
  EXPECT_THAT(found.sentences, Contains(HasSubstr("Nothing is found of the inertial unit against "
                                                  "the camera")));
  EXPECT_EQ(to_toml(found.description), to_toml(wrong_car()));
}

TEST(Extrinsics, ADriveThatIsTooShortShowsNothing) {
  const Extrinsics found = find_extrinsics(measured(MadeMotion({.seconds = 4.0})), wrong_car());
  EXPECT_TRUE(found.values.empty());
  EXPECT_THAT(found.sentences, Contains(HasSubstr("fewer than 6 s")));
}

TEST(Extrinsics, OneGyroLeavesYawToTheDirectionOfTravel) {
  Measurements m = measured(MadeMotion({.axle = axle}));
  m.inertial.vertical_alone = true;
  for (RateSample& s : m.inertial.samples) s.rate.head<2>().setZero();
  const Extrinsics found = find_extrinsics(m, wrong_car());
  EXPECT_THAT(found.sentences, Contains(HasSubstr("The unit has one gyro")));
  expect(found, "camera", "yaw", 0.5, 0.5);
  EXPECT_GT(value(found, "camera", "yaw").sigma, 0.25) << "how well the unit is mounted";
  expect(found, "imu", "delay", 0.03, 0.004);
}

TEST(Extrinsics, WithoutAnInertialUnitTheLidarIsFoundFromTheCamera) {
  Measurements m = measured(MadeMotion({.axle = axle}));
  m.inertial = {};
  VehicleDescription car = wrong_car();
  car.camera.rotation = true_car().camera.rotation;
  car.camera.rotation.roll_sigma = car.camera.rotation.pitch_sigma = car.camera.rotation.yaw_sigma =
      0.1;
  const Extrinsics found = find_extrinsics(m, car);
  expect(found, "lidar", "yaw", 2.0, 0.3);
  expect(found, "lidar", "forward", 0.4, 0.1);
  expect(found, "lidar", "delay", 0.015, 0.003);
  EXPECT_EQ(found.description.camera.rotation.yaw, car.camera.rotation.yaw);
}

TEST(Extrinsics, WithoutAnyImageTheUnitIsLateAgainstTheLidar) {
  Measurements m = measured(MadeMotion({.axle = axle}));
  m.camera = {};
  const Extrinsics found = find_extrinsics(m, wrong_car());
  expect(found, "imu", "delay", 0.015, 0.003);
  expect(found, "lidar", "roll", -0.5, 0.2);
}

TEST(Extrinsics, NoSensorStampsBeforeItMeasuresSoTheOthersAreLate) {
  const MadeMotion motion({.axle = axle});
  Measurements m = measured(motion);
  m.inertial.samples = motion.of_gyros(-0.05, 1e-4);
  const Extrinsics found = find_extrinsics(m, wrong_car());
  expect(found, "camera", "delay", 0.05, 0.003);
  expect(found, "lidar", "delay", 0.065, 0.003);
  EXPECT_EQ(value(found, "imu", "delay").value, 0.0);
  EXPECT_TRUE(value(found, "imu", "delay").observed);
}

TEST(Extrinsics, TheCameraMovesIfTheLidarIsDescribedBetter) {
  VehicleDescription car = wrong_car();
  car.lidar.position = true_car().lidar.position;
  car.lidar.position.left_sigma = 0.01;
  car.camera.position.left = 0.0;
  car.camera.position.left_sigma = 0.5;
  const Extrinsics found = find_extrinsics(measured(MadeMotion({.turns = 0.6, .axle = axle})), car);
  expect(found, "camera", "left", 0.3, 0.1);
  EXPECT_EQ(found.description.lidar.position.left, -0.1);
  expect(found, "lidar", "forward", 0.4, 0.1);
}

TEST(Extrinsics, AMountThatIsFoundIsWritten) {
  Measurements m;
  m.inertial.samples = MadeMotion().of_gyros(0.0);
  m.inertial.mount.emplace();
  EXPECT_THAT(find_extrinsics(m, {}).sentences, Contains(HasSubstr("is not found")));
  sensors::Mount& mount = *m.inertial.mount;
  mount.status = sensors::MountStatus::found;
  mount.R_body_unit = rotation_of({0.0, 0.0, radians(-90.0)});
  mount.level_sigma = radians(0.1);
  mount.forward_sigma = radians(0.5);
  const Extrinsics found = find_extrinsics(m, {});
  expect(found, "imu", "yaw", -90.0, 1e-6);
  EXPECT_NEAR(value(found, "imu", "yaw").sigma, 0.5, 1e-3);
  EXPECT_NEAR(found.description.imu.rotation.roll_sigma, 0.58, 0.01) << "accelerometers";
  EXPECT_THAT(found.sentences, Not(Contains(HasSubstr("gyros")))) << "no turns, no axis of them";
  mount.turning = {{0.0, std::sin(radians(1.5)), std::cos(radians(1.5))}, radians(0.2)};
  EXPECT_THAT(find_extrinsics(m, {}).sentences,
              Contains(HasSubstr("roll is 1.5 and pitch 0.0 deg (sigma 0.2), 1.5 deg from")));
}

// There, roll and yaw are uncertain by nearly twice as much as the rotation.
TEST(Extrinsics, AMountNearTheUprightIsWrittenWhole) {
  Measurements m;
  m.inertial.samples = MadeMotion().of_gyros(0.0);
  sensors::Mount& mount = m.inertial.mount.emplace();
  mount.status = sensors::MountStatus::found;
  mount.R_body_unit = rotation_of({0.0, radians(60.0), radians(20.0)});
  mount.level_sigma = mount.forward_sigma = radians(0.6);
  const Extrinsics found = find_extrinsics(m, {});
  EXPECT_GT(value(found, "imu", "roll").sigma, observed_angle);
  for (const char* angle : {"roll", "pitch", "yaw"})
    EXPECT_TRUE(value(found, "imu", angle).observed) << angle;
  mount.level_sigma = radians(1.2);
  const Extrinsics uncertain = find_extrinsics(m, {});
  for (const char* angle : {"roll", "pitch", "yaw"})
    EXPECT_FALSE(value(uncertain, "imu", angle).observed) << angle;
}

}  // namespace
}  // namespace maploop::extrinsics
