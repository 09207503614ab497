// Parameters of the guard against wrong roads.
#pragma once

namespace maploop::fusion {

struct GuardParameters {
  double lifetime = 60.0;  // s of a copy; two of them, half of that apart
  double difference_gate =
      13.8;               // chi-square, 2 degrees of freedom, 0.1 % tail: too far from a copy ...
  double patience = 5.0;  // s, ... for so long: a wrong road
  double trusted = 4.6;   // chi-square, 10 % tail: a new copy is made of what is no further away
  double pause = 10.0;    // s without feedback after a restoration
  double lost_azimuth = 0.087;  // rad (5 deg), sigma of an azimuth that is lost
  // The errors squared of dead reckoning are so much larger than its covariance says: drives
  // without GNSS for 60 s have a mean NEES of 2.9 to 4 where 2 is expected.
  double overconfidence = 2.0;
  // What the two may differ by beyond their covariances: the copy's model errs, too.
  double model_sigma = 1.0;   // m
  double model_share = 0.01;  // 1, of the copy's way
};

}  // namespace maploop::fusion
