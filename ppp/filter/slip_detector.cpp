#include "ppp/filter/slip_detector.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ppp/filter/clock_steps.h"

namespace maploop::ppp {
namespace {

constexpr double longest_growth = 30.0;  // s; the ionosphere does not drift away for longer
constexpr double low_factor = 2.0;       // on limits at low elevations, where phases are noisier
constexpr double unknown_rate_factor = 1.5;

// The wide lane's mean and variance, from the noise of one code to a memory of 100 epochs.
constexpr double first_wide_variance = 0.25, least_wide_variance = 0.01;  // m^2
constexpr int fewest_wide_lanes = 5, longest_wide_memory = 100;           // epochs
constexpr double wide_sigmas = 5.0;
constexpr double low_wide_lanes = 2.0;  // in place of `slip_wide_lanes`

constexpr double longest_doppler = 5.0;  // s; over longer intervals the speed is not linear

bool is_low(double elevation, const PppParameters& parameters) {
  return elevation < parameters.slip_low_elevation;
}

}  // namespace

double slip_limit(double at_once, double interval, double elevation,
                  const PppParameters& parameters) {
  return (at_once + parameters.slip_growth * std::min(std::abs(interval), longest_growth)) *
         (is_low(elevation, parameters) ? low_factor : 1.0);
}

PppSlip SlipDetector::next(const Measurement& m, double interval, double elevation,
                           const PppParameters& parameters) {
  PppSlip slip = m.first.lost_lock || m.second.lost_lock ? PppSlip::lost_lock : PppSlip::none;
  if (m.dual()) {
    const Combinations now{m.first.phase - m.second.phase, m.wide_lane(), m.wide_lane_length()};
    if (slip == PppSlip::none && started_) slip = compare(now, interval, elevation, parameters);
    learn(now, slip == PppSlip::none && started_, interval);
  } else if (slip == PppSlip::none && started_) {
    slip = compare_with_doppler(m, interval, parameters);
  }
  phase_ = m.first.phase;
  doppler_ = m.first.doppler;
  return std::exchange(started_, true) ? slip : PppSlip::none;
}

// The rate of the ionosphere is assumed to be constant.
PppSlip SlipDetector::compare(const Combinations& now, double interval, double elevation,
                              const PppParameters& parameters) const {
  // (17) of METHOD.md
  const double predicted = geometry_free_ + (has_rate_ ? rate_ * interval : 0.0);
  const double limit = slip_limit(parameters.slip_geometry_free, interval, elevation, parameters) *
                       (has_rate_ ? 1.0 : unknown_rate_factor);
  if (std::abs(now.geometry_free - predicted) > limit) return PppSlip::geometry_free;
  const double sigma = std::sqrt(std::max(wide_variance_, least_wide_variance));
  const double lanes = is_low(elevation, parameters) ? low_wide_lanes : parameters.slip_wide_lanes;
  if (wide_count_ >= fewest_wide_lanes &&
      std::abs(now.wide_lane - wide_mean_) >
          std::max(wide_sigmas * sigma, lanes * now.wide_lane_length)) {
    return PppSlip::wide_lane;
  }
  return PppSlip::none;
}

void SlipDetector::learn(const Combinations& now, bool goes_on, double interval) {
  has_rate_ = goes_on;
  if (goes_on) {
    rate_ = (now.geometry_free - geometry_free_) / interval;
    wide_count_ = std::min(wide_count_ + 1, longest_wide_memory);
    const double gain = 1.0 / wide_count_, off = now.wide_lane - wide_mean_;
    wide_mean_ += gain * off;
    wide_variance_ += gain * (off * off - wide_variance_);
  } else {
    wide_mean_ = now.wide_lane;
    wide_variance_ = first_wide_variance;
    wide_count_ = 1;
  }
  geometry_free_ = now.geometry_free;
}

PppSlip SlipDetector::compare_with_doppler(const Measurement& m, double interval,
                                           const PppParameters& parameters) const {
  if (doppler_ == 0.0 || m.first.doppler == 0.0 || std::abs(interval) >= longest_doppler)
    return PppSlip::none;
  const double expected = -0.5 * (doppler_ + m.first.doppler) * m.first.wavelength * interval;
  // Whole milliseconds are removed, by which the receiver may have stepped its clock.
  // (19) of METHOD.md
  const double off = std::remainder(m.first.phase - phase_ - expected, millisecond_range);
  const double limit = parameters.slip_doppler + parameters.slip_doppler * std::abs(interval);
  return std::abs(off) > limit ? PppSlip::doppler : PppSlip::none;
}

}  // namespace maploop::ppp
