// Detects cycle slips of one satellite. With two carriers it uses loss of lock and the
// geometry-free and Melbourne-Wuebbena combinations. With one carrier it uses loss of lock and
// Doppler, which reveals slips of half a metre and more; phase_steps.h finds smaller ones.
#pragma once

#include "msgs/ppp_state.h"
#include "ppp/filter/measurement.h"
#include "ppp/filter/parameters.h"

namespace maploop::ppp {

// Returns how much phases may differ without a slip, m: `at_once` (m) plus `slip_growth` for each
// second of `interval` (either way) up to 30 s, and twice that below `slip_low_elevation`.
double slip_limit(double at_once, double interval, double elevation,
                  const PppParameters& parameters);

class SlipDetector {
 public:
  // Takes the satellite's next epoch and returns what indicated a slip, or none. `interval` is the
  // time since the previous epoch, s; `elevation` is in rad.
  PppSlip next(const Measurement& m, double interval, double elevation,
               const PppParameters& parameters);
  void reset() { *this = {}; }

  template <class Archive>
  void archive(Archive& ar) {
    ar(started_, geometry_free_, rate_, has_rate_, wide_mean_, wide_variance_, wide_count_, phase_,
       doppler_);
  }

 private:
  struct Combinations {
    double geometry_free, wide_lane;  // m
    double wide_lane_length;          // m
  };
  PppSlip compare(const Combinations& now, double interval, double elevation,
                  const PppParameters& parameters) const;
  void learn(const Combinations& now, bool goes_on, double interval);
  PppSlip compare_with_doppler(const Measurement& m, double interval,
                               const PppParameters& parameters) const;

  bool started_ = false;
  double geometry_free_ = 0.0, rate_ = 0.0;  // m, m/s
  bool has_rate_ = false;
  double wide_mean_ = 0.0, wide_variance_ = 0.0;  // m
  int wide_count_ = 0;
  double phase_ = 0.0, doppler_ = 0.0;  // m, Hz
};

}  // namespace maploop::ppp
