#include "ppp/filter/slip_detector.h"

#include <gtest/gtest.h>

#include <cmath>

namespace maploop::ppp {
namespace {

Measurement at(int second) {
  Measurement m;
  m.satellite = {System::gps, 7};
  m.first = {'1', 'W', 1575.42e6, speed_of_light / 1575.42e6};
  m.second = {'2', 'W', 1227.60e6, speed_of_light / 1227.60e6};
  const double range = 2.2e7 + 500.0 * second;
  const double ionosphere = 3.0 + 0.001 * second;
  const double ratio = std::pow(1575.42 / 1227.60, 2);
  m.first.code = range + ionosphere + 0.3 * std::sin(second);
  m.second.code = range + ratio * ionosphere - 0.3 * std::sin(2.0 * second);
  m.first.phase = range - ionosphere + 11.0;
  m.second.phase = range - ratio * ionosphere - 5.0;
  m.first.doppler = -500.0 / m.first.wavelength;
  return m;
}

PppSlip after_quiet(SlipDetector& detector, const Measurement& last) {
  for (int t = 0; t < 30; ++t) {
    EXPECT_EQ(detector.next(at(t), 1.0, 0.8, {}), PppSlip::none) << t;
  }
  return detector.next(last, 1.0, 0.8, {});
}

TEST(SlipDetector, OneCycleOnOneCarrier) {
  SlipDetector detector;
  Measurement m = at(30);
  m.first.phase += m.first.wavelength;
  EXPECT_EQ(after_quiet(detector, m), PppSlip::geometry_free);
}

TEST(SlipDetector, WhatTheGeometryFreeCombinationDoesNotSee) {
  SlipDetector detector;
  Measurement m = at(30);
  m.first.phase += 9.0 * m.first.wavelength;    // 1.7126 m
  m.second.phase += 7.0 * m.second.wavelength;  // 1.7095 m
  EXPECT_EQ(after_quiet(detector, m), PppSlip::wide_lane);
}

TEST(SlipDetector, LossOfLockAndNothing) {
  SlipDetector detector;
  Measurement m = at(30);
  m.second.lost_lock = true;
  EXPECT_EQ(after_quiet(detector, m), PppSlip::lost_lock);
  SlipDetector quiet;
  EXPECT_EQ(after_quiet(quiet, at(30)), PppSlip::none);
}

TEST(SlipDetector, OneFrequencyByDoppler) {
  const auto single = [](int t) {
    Measurement m = at(t);
    m.second = {};
    return m;
  };
  SlipDetector detector;
  EXPECT_EQ(detector.next(single(0), 1.0, 0.8, {}), PppSlip::none);
  EXPECT_EQ(detector.next(single(1), 1.0, 0.8, {}), PppSlip::none);
  Measurement m = single(2);
  m.first.phase += 10.0 * m.first.wavelength;
  EXPECT_EQ(detector.next(m, 1.0, 0.8, {}), PppSlip::doppler);
}

}  // namespace
}  // namespace maploop::ppp
