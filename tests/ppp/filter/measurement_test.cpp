#include "ppp/filter/measurement.h"

#include <gtest/gtest.h>

#include <cmath>

namespace maploop::ppp {
namespace {

Carrier carrier(char band, double code, double phase) {
  const double frequency = carrier_frequency(System::gps, band);
  Carrier c;
  c.band = band;
  c.frequency = frequency;
  c.wavelength = speed_of_light / frequency;
  c.code = code;
  c.phase = phase;
  return c;
}

// A satellite with the range 1000 m beyond 2e7 m, and this ionosphere on GPS L1.
Measurement with_ionosphere(double delay) {
  Measurement m;
  m.satellite = {System::gps, 5};
  m.first = carrier('1', 0.0, 0.0);
  m.second = carrier('2', 0.0, 0.0);
  for (Carrier* c : {&m.first, &m.second}) {
    c->code = 2.0001e7 + ionosphere_factor(*c) * delay;
    c->phase = 2.0001e7 - ionosphere_factor(*c) * delay;
  }
  return m;
}

TEST(Measurement, WhatBothCarriersHaveInCommonIsInTheRangeAlone) {
  const Measurement direct = with_ionosphere(3.0);
  Measurement reflected = direct;
  reflected.first.code += 20.0;
  reflected.second.code += 20.0;
  EXPECT_DOUBLE_EQ(reflected.code(Combination::range) - direct.code(Combination::range), 20.0);
  EXPECT_DOUBLE_EQ(reflected.code(Combination::ionosphere), direct.code(Combination::ionosphere));
}

TEST(Measurement, TheDifferenceOfTheCarriersIsTheIonosphereAlone) {
  const Measurement m = with_ionosphere(3.0);
  EXPECT_NEAR(m.code(Combination::ionosphere), 3.0 * m.ionosphere(Combination::ionosphere), 1e-7);
  EXPECT_NEAR(m.phase(Combination::ionosphere), -3.0 * m.ionosphere(Combination::ionosphere), 1e-7);
}

TEST(Measurement, RangeAndWeightedIonosphereAreFreeOfIt) {
  const Measurement m = with_ionosphere(7.0);
  const double weight = m.ionosphere_free_weight();
  EXPECT_NEAR(m.code(Combination::range) + weight * m.code(Combination::ionosphere), 2.0001e7,
              1e-6);
  EXPECT_NEAR(m.phase(Combination::range) + weight * m.phase(Combination::ionosphere), 2.0001e7,
              1e-6);
}

TEST(Measurement, OneCarrierIsItsOwnRange) {
  Measurement m = with_ionosphere(3.0);
  m.second = {};
  EXPECT_EQ(m.code(Combination::range), m.first.code);
  EXPECT_EQ(m.phase(Combination::range), m.first.phase);
  EXPECT_EQ(m.ionosphere(Combination::range), 1.0);
}

TEST(Measurement, NoiseOfTheMeanFallsWithASecondCarrierAndACommonErrorDoesNot) {
  const Measurement two = with_ionosphere(3.0);
  Measurement one = two;
  one.second = {};
  EXPECT_DOUBLE_EQ(one.sigma(Combination::range, 0.4, 0.9), std::hypot(0.4, 0.9));
  EXPECT_DOUBLE_EQ(two.sigma(Combination::range, 0.4, 0.9), std::hypot(0.4 / std::sqrt(2.0), 0.9));
  EXPECT_DOUBLE_EQ(two.sigma(Combination::ionosphere, 0.4, 0.9), 0.4 / std::sqrt(2.0));
}

}  // namespace
}  // namespace maploop::ppp
