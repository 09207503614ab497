#include "ppp/filter/slip_detector.h"

#include <algorithm>
#include <cmath>

#include "ppp/filter/clock_steps.h"

namespace maploop::ppp {

namespace {

bool is_low(double elevation) {
  return elevation < 0.26;
}

}  // namespace

double slip_limit(double at_once, double interval, double elevation) {
  return (at_once + 0.002 * std::min(interval, 30.0)) * (is_low(elevation) ? 2.0 : 1.0);
}

PppSlip SlipDetector::next(const Measurement& m, double interval, double elevation) {
  PppSlip slip = PppSlip::none;
  if (m.first.lost_lock || m.second.lost_lock) slip = PppSlip::lost_lock;
  if (m.dual()) {
    const double geometry_free = m.first.phase - m.second.phase;
    const double f1 = m.first.frequency, f2 = m.second.frequency;
    // (18) of METHOD.md
    const double wide = (f1 * m.first.phase - f2 * m.second.phase) / (f1 - f2) -
                        (f1 * m.first.code + f2 * m.second.code) / (f1 + f2);
    const double wide_length = speed_of_light / (f1 - f2);
    if (started_) {
      // The rate of the ionosphere is assumed to be constant.
      // (17) of METHOD.md
      const double predicted = geometry_free_ + (has_rate_ ? rate_ * interval : 0.0);
      const double limit = slip_limit(0.04, interval, elevation) * (has_rate_ ? 1.0 : 1.5);
      const double sigma = std::sqrt(std::max(wide_variance_, 0.01));
      if (slip == PppSlip::none && std::abs(geometry_free - predicted) > limit)
        slip = PppSlip::geometry_free;
      if (slip == PppSlip::none && wide_count_ >= 5 &&
          std::abs(wide - wide_mean_) >
              std::max(5.0 * sigma, (is_low(elevation) ? 2.0 : 1.2) * wide_length)) {
        slip = PppSlip::wide_lane;
      }
    }
    if (slip != PppSlip::none || !started_) {
      wide_mean_ = wide;
      wide_variance_ = 0.25;
      wide_count_ = 1;
      has_rate_ = false;
    } else {
      rate_ = (geometry_free - geometry_free_) / interval;
      has_rate_ = true;
      wide_count_ = std::min(wide_count_ + 1, 100);
      const double gain = 1.0 / wide_count_, off = wide - wide_mean_;
      wide_mean_ += gain * off;
      wide_variance_ += gain * (off * off - wide_variance_);
    }
    geometry_free_ = geometry_free;
  } else if (started_ && slip == PppSlip::none && doppler_ != 0.0 && m.first.doppler != 0.0 &&
             interval < 5.0) {
    const double expected = -0.5 * (doppler_ + m.first.doppler) * m.first.wavelength * interval;
    // Whole milliseconds are removed, by which the receiver may have stepped its clock.
    // (19) of METHOD.md
    const double off = std::remainder(m.first.phase - phase_ - expected, millisecond_range);
    if (std::abs(off) > 0.5 + 0.5 * interval) {
      slip = PppSlip::doppler;
    }
  }
  phase_ = m.first.phase;
  doppler_ = m.first.doppler;
  const bool first = !started_;
  started_ = true;
  return first ? PppSlip::none : slip;
}

}  // namespace maploop::ppp
