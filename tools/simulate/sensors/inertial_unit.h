// Simulates the errors of an inertial unit, and writes the rows of the inertial and GNSS unit in
// KITTI's format.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "msgs/local_frame.h"
#include "msgs/time.h"
#include "sensors/replay/normal_generator.h"
#include "tools/simulate/sensors/vehicle_motion.h"

namespace maploop::simulate {

enum class ImuGrade : std::uint8_t { tactical, mems };
constexpr std::array<std::string_view, 2> names_of(ImuGrade) {
  return {"tactical", "mems"};
}

// The errors of one triad: turn-on bias, flicker as the sum of three Gauss-Markov processes (10,
// 100 and 1000 s; the estimator models one process only), white noise, scale, misalignment.
struct TriadParameters {
  double turn_on = 0.0;       // rad/s or m/s^2, 1 sigma
  double instability = 0.0;   // the same, 1 sigma of the sum
  double white = 0.0;         // per sqrt(Hz)
  double scale = 0.0;         // 1, 1 sigma
  double misalignment = 0.0;  // rad, 1 sigma of each axis against each other
};
struct ImuParameters {
  TriadParameters gyros, accelerometers;
};
// tactical: 2 deg/h and 0.2 deg/sqrt(h), 1 mg, as data sheets of OXTS units state; mems: 300 deg/h
// turn-on, 10 deg/h instability, 0.3 deg/sqrt(h), 20 mg.
ImuParameters imu_parameters(ImuGrade grade);

class TriadErrors {
 public:
  // Samples are `interval` seconds apart.
  TriadErrors(const TriadParameters& parameters, double interval, std::uint64_t seed,
              std::uint64_t stream);

  Eigen::Vector3d measure(const Eigen::Vector3d& truth);

 private:
  Eigen::Vector3d normal();

  TriadParameters parameters_;
  double interval_;
  sensors::NormalGenerator random_;
  Eigen::Vector3d turn_on_;
  Eigen::Matrix3d shape_;  // scale and misalignment
  std::array<Eigen::Vector3d, 3> flicker_;
};

// Writes rows `interval` seconds apart, beginning at `start`, into the new folder `oxts`. Position
// and attitude are exact at the row's stamp. Velocities (exact), accelerations and rates (with the
// errors of `imu`) are those of `delay` seconds before it, as in KITTI's drives.
void write_oxts(const std::filesystem::path& oxts, const VehicleMotion& motion,
                const LocalFrame& frame, Time start, double seconds, double interval,
                const ImuParameters& imu, double delay, std::uint64_t seed);

// Writes stamps like KITTI's timestamps.txt, one a line.
void write_timestamps(const std::filesystem::path& file, const std::vector<Time>& stamps);

}  // namespace maploop::simulate
