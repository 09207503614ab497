// Simulates the errors of an inertial unit.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string_view>

#include "sensors/replay/normal_generator.h"

namespace maploop::simulate {

enum class ImuGrade { tactical, mems };

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

}  // namespace maploop::simulate
