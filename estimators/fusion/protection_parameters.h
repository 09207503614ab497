// These are the parameters of the protection levels; protection_parameter_table.cpp describes each.
#pragma once

namespace maploop::fusion {

struct ProtectionParameters {
  double integrity_risk = 1e-4;
  double overconfidence = 2.0;
  double model_sigma = 0.5;  // m
  double model_share = 0.01;
  double window = 30.0;      // s
  double fix_memory = 10.0;  // s
  double map_fault = 0.01;
  double gnss_fault = 1e-3;
  double odometry_fault = 1e-3;
};

}  // namespace maploop::fusion
