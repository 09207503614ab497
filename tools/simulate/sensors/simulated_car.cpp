#include "tools/simulate/sensors/simulated_car.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>

#include "sensors/replay/kitti_calibration.h"
#include "tools/simulate/output_file.h"
#include "tools/simulate/random.h"

namespace maploop::simulate {
namespace {

using Eigen::Isometry3d, Eigen::Matrix3d, Eigen::Vector3d;

constexpr const char* cam_to_cam =
    R"(calib_time: simulated
S_rect_00: 1.242000e+03 3.750000e+02
R_rect_00: 1 0 0 0 1 0 0 0 1
P_rect_00: 7.215377e+02 0 6.095593e+02 0 0 7.215377e+02 1.728540e+02 0 0 0 1 0
S_rect_01: 1.242000e+03 3.750000e+02
R_rect_01: 1 0 0 0 1 0 0 0 1
P_rect_01: 7.215377e+02 0 6.095593e+02 -3.875744e+02 0 7.215377e+02 1.728540e+02 0 0 0 1 0
)";

// Returns a file of KITTI's with a rigid motion.
std::string rigid_text(const Isometry3d& T) {
  const Matrix3d& R = T.linear();
  const Vector3d t = T.translation();
  return fmt::format("calib_time: simulated\nR: {} {} {} {} {} {} {} {} {}\nT: {} {} {}\n", R(0, 0),
                     R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2), t.x(),
                     t.y(), t.z());
}

Vector3d horizontal(Random& random, double length) {
  const double azimuth = random.uniform(0.0, 2.0 * std::numbers::pi);
  return {length * std::cos(azimuth), length * std::sin(azimuth), 0.0};
}

SimulatedCar standard_car() {
  SimulatedCar car;
  car.T_cam_velo.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  car.T_cam_velo.translation() << 0, -0.08, -0.27;
  car.T_velo_body.translation() << -0.81, 0.32, -0.8;
  return car;
}

// Turns and moves a sensor by up to `angle` deg about each axis and `way` m along each.
Isometry3d moved(Random& random, const Isometry3d& T_car_sensor, double angle, double way) {
  const auto to = [&](double most) { return random.uniform(-most, most); };
  const double roll = to(angle), pitch = -to(angle), yaw = to(angle);
  const double forward = to(way), left = to(way), up = 0.2 * to(way);
  const Isometry3d by = sensor_pose({forward, left, up}, {roll, pitch, yaw});
  Isometry3d T = T_car_sensor;
  T.linear() = by.linear() * T.linear();
  T.translation() += by.translation();
  return T;
}

SimulatedCar drawn_car(std::uint64_t seed) {
  Random random(seed, 33);
  SimulatedCar car = standard_car();
  const Isometry3d T_car_velo_standard = car.T_velo_body.inverse();
  const Isometry3d T_car_cam_standard = T_car_velo_standard * car.T_cam_velo.inverse();
  const double axle = random.uniform(0.0, 2.0);
  const double roll = random.uniform(-3.0, 3.0), climb = random.uniform(-1.0, 1.0);
  const double yaw = random.uniform(-3.0, 3.0);
  car.T_car_body = sensor_pose({axle, 0.0, 0.0}, {roll, -climb, yaw});
  const Isometry3d T_car_velo = moved(random, T_car_velo_standard, 2.0, 0.5);
  const Isometry3d T_car_cam = moved(random, T_car_cam_standard, 2.0, 0.5);
  car.T_cam_velo = T_car_cam.inverse() * T_car_velo;
  car.T_velo_body = T_car_velo.inverse() * car.T_car_body;
  const Vector3d antenna_in_car =
      Vector3d(axle, 0.0, 0.75) + horizontal(random, random.uniform(0.0, 1.0));
  car.antenna = car.T_car_body.inverse() * antenna_in_car;
  car.imu_delay = random.uniform(0.0, 0.05);
  car.camera_delay = random.uniform(0.0, 0.05);
  return car;
}

}  // namespace

SimulatedCar simulated_car(CarKind kind, std::uint64_t seed) {
  return kind == CarKind::standard ? standard_car() : drawn_car(seed);
}

void write_calibration(const std::filesystem::path& folder, const SimulatedCar& car) {
  write_file(folder / "calib_cam_to_cam.txt", cam_to_cam);
  write_file(folder / "calib_velo_to_cam.txt", rigid_text(car.T_cam_velo));
  write_file(folder / "calib_imu_to_velo.txt", rigid_text(car.T_velo_body));
}

VehicleCalibration calibration_of(const SimulatedCar& car) {
  return sensors::parse_kitti_calibration({cam_to_cam, rigid_text(car.T_cam_velo),
                                           rigid_text(car.T_velo_body), "calib_cam_to_cam",
                                           "calib_velo_to_cam", "calib_imu_to_velo"});
}

VehicleDescription description_of(const SimulatedCar& car) {
  VehicleDescription d = description_of(calibration_of(car));
  d.car.rear_axle_distance = car.T_car_body.translation().x();
  d.car.rear_axle_distance_sigma = 0.01;
  const Vector3d travel = car.T_car_body.linear().row(0).transpose();  // in the body's axes
  d.car.climb_offset = std::asin(travel.z());
  d.car.climb_offset_sigma = 0.0087;
  d.car.rear_slip = 0.0;
  d.car.rear_slip_sigma = 0.0005;
  d.imu.time = {car.imu_delay, 0.005};
  if (car.camera_delay > 0.0) d.camera.time = {car.camera_delay, 0.005};
  d.antenna.position = {car.antenna.x(), car.antenna.y(), car.antenna.z(), 0.01, 0.01, 0.01};
  return d;
}

VehicleDescription rough_description(const SimulatedCar& car, std::uint64_t seed) {
  Random random(seed, 34);
  constexpr double place = 0.5, place_sigma = 0.4;  // m
  const auto degree = [&] { return random.chance(0.5) ? 1.0 : -1.0; };
  SimulatedCar believed = car;
  const double roll = degree(), pitch = -degree(), yaw = degree();
  const Vector3d by = horizontal(random, place);
  const Isometry3d X = sensor_pose({by.x(), by.y(), 0.0}, {roll, pitch, yaw});
  believed.T_velo_body = car.T_velo_body * X.inverse();
  believed.antenna += horizontal(random, place);
  VehicleDescription d = description_of(calibration_of(believed));
  const auto& p = believed.antenna;
  d.antenna.position = {p.x(), p.y(), p.z(), place_sigma, place_sigma, place_sigma};
  for (SensorPosition* sensor : {&d.camera.position, &d.lidar.position})
    sensor->forward_sigma = sensor->left_sigma = place_sigma;
  for (SensorRotation* sensor : {&d.camera.rotation, &d.lidar.rotation})
    sensor->roll_sigma = sensor->pitch_sigma = sensor->yaw_sigma = 1.0;
  d.imu.time = {0.0, 0.05};
  d.camera.time = {0.0, 0.05};
  return d;
}

}  // namespace maploop::simulate
