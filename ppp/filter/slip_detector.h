// Cycle slips of one satellite: loss of lock, geometry-free and Melbourne-Wuebbena combinations
// with two carriers; Doppler with one, which sees half a metre and more: for less see
// phase_steps.h.
#pragma once

#include "msgs/ppp_state.h"
#include "ppp/filter/measurement.h"

namespace maploop::ppp {

// m: what phases may differ by, of that at once, after `interval` s; at low elevations twice that.
double slip_limit(double at_once, double interval, double elevation);

class SlipDetector {
 public:
  // Takes the next epoch of the satellite; what told that the phase slipped, if it did. `interval`
  // is the time since the epoch before.
  PppSlip next(const Measurement& m, double interval, double elevation);
  void reset() { *this = {}; }

  template <class Archive>
  void archive(Archive& ar) {
    ar(started_, geometry_free_, rate_, has_rate_, wide_mean_, wide_variance_, wide_count_, phase_,
       doppler_);
  }

 private:
  bool started_ = false;
  double geometry_free_ = 0.0, rate_ = 0.0;  // m, m/s
  bool has_rate_ = false;
  double wide_mean_ = 0.0, wide_variance_ = 0.0;  // m
  int wide_count_ = 0;
  double phase_ = 0.0, doppler_ = 0.0;  // m, Hz
};

}  // namespace maploop::ppp
