// The car that carries the simulated sensors: where they are, and how late their stamps are.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include "msgs/calibration.h"
#include "msgs/vehicle_description.h"

namespace maploop::simulate {

enum class CarKind : std::uint8_t { standard, drawn };
constexpr std::array<std::string_view, 2> names_of(CarKind) {
  return {"standard", "drawn"};
}

// The car's axes are forward along the direction of travel, left and up, above its rear axle. The
// body's are those of the inertial unit, wherever it is and however it is turned. The standard car
// has KITTI's camera (1242 x 375 pixels, 0.537 m baseline) and mounting of 2011-09-26, rounded, and
// its unit above the rear axle.
struct SimulatedCar {
  Eigen::Isometry3d T_car_body = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_cam_velo = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_velo_body = Eigen::Isometry3d::Identity();
  Eigen::Vector3d antenna{0.0, 0.0, 0.75};  // m, in the body's axes
  double imu_delay = 0.06;                  // s, from the measurement of a rate to its stamp
  double camera_delay = 0.0;                // s, the same of images
};

// Draws from the seed: the unit 0 to 2 m ahead of the rear axle and turned by up to 3 degrees about
// the vertical and the forward axis and 1 degree about the left one, which is then the angle of
// climb; camera and scanner up to 0.5 m elsewhere on the roof and turned by up to 2 degrees; the
// antenna up to 1 m from above the unit; stamps of unit and images up to 50 ms late.
SimulatedCar simulated_car(CarKind kind, std::uint64_t seed);

// Writes where camera, scanner and unit are as KITTI's three files into a folder. Throws
// std::runtime_error naming the file.
void write_calibration(const std::filesystem::path& folder, const SimulatedCar& car);
// Returns what the files say.
VehicleCalibration calibration_of(const SimulatedCar& car);

// Returns all that there is to know of the car. It moves along its own x axis, except for the
// motion of its springs (vehicle_motion.h); its tyres do not slip sideways.
VehicleDescription description_of(const SimulatedCar& car);

// Returns what its owner knows who has a tape measure: camera and scanner, which are calibrated
// against each other, 0.5 m and a degree elsewhere, the antenna 0.5 m; nothing of how the unit is
// mounted, and of delays. The errors are drawn from the seed.
VehicleDescription rough_description(const SimulatedCar& car, std::uint64_t seed);

}  // namespace maploop::simulate
