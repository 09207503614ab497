// These are the parameters of the guard against wrong roads; guard_parameter_table.cpp describes
// each.
#pragma once

namespace maploop::fusion {

struct GuardParameters {
  double lifetime = 60.0;  // s
  double difference_gate = 13.8;
  double patience = 5.0;  // s
  double trusted = 4.6;
  double pause = 10.0;          // s
  double lost_azimuth = 0.087;  // rad (5 deg)
  double overconfidence = 2.0;
  double model_sigma = 1.0;  // m
  double model_share = 0.01;
};

}  // namespace maploop::fusion
