// Tests the choice and the confirmation of integers on ambiguities that are made up.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <vector>

#include "ppp/integers/integer_fix.h"

namespace maploop::ppp {
namespace {

constexpr int satellites = 8;
constexpr int unknown_entry =
    FilterState::zenith_wet;  // stands for anything that all have in common

// Satellites of GPS that have these integers and real-valued ambiguities of this standard deviation
// (m), which besides depend on an unknown of `unknown_sigma` m, each by another factor.
class IntegerSearch : public ::testing::Test {
 public:
  void make(double sigma, double unknown_sigma) {
    state.clear();
    state.set(unknown_entry, 0.0, unknown_sigma);
    tracked.clear();
    rows.clear();
    for (int i = 0; i < satellites; ++i) add_satellite(i, sigma);
    auto P = state.P();
    for (int i = 0; i < satellites; ++i) {
      for (int k = 0; k < satellites; ++k)
        P(ambiguity(i), ambiguity(k)) += factor(i) * factor(k) * unknown_sigma * unknown_sigma;
      P(ambiguity(i), unknown_entry) = P(unknown_entry, ambiguity(i)) =
          factor(i) * unknown_sigma * unknown_sigma;
    }
  }

  // Adds cycles to the first and to the second carrier's ambiguity.
  void shift(int i, double first, double second) {
    const Measurement& m = tracked[static_cast<std::size_t>(i)].measurement;
    const double a = m.first.wavelength * first, b = m.second.wavelength * second;
    state.x()[ambiguity(i)] += 0.5 * (a + b);
    state.x()[ambiguity(i) + 1] += 0.5 * (b - a);
  }

  const FilterState* resolve(double second) {
    report = {};
    std::vector<SatelliteReport> reports(satellites);
    const FilterState* const fixed =
        integers.resolve(state, tracked, rows, start + from_seconds(second), report, reports);
    marked = 0;
    for (const SatelliteReport& r : reports) marked += r.integer;
    return fixed;
  }

  int ambiguity(int i) const {
    return state.find(tracked[static_cast<std::size_t>(i)].measurement.satellite, Part::ambiguity);
  }
  static double factor(int i) { return 1.0 + 0.1 * i * i; }

  const GpsTime start = gps_time({2020, 6, 25, 12, 0, 0.0});
  PppParameters parameters;
  IntegerFix integers{parameters};
  FilterState state;
  std::vector<Tracked> tracked;
  std::vector<Row> rows;
  IntegerReport report;
  int marked = 0;

 private:
  void add_satellite(int i, double sigma) {
    Tracked t;
    Measurement& m = t.measurement;
    m.satellite = {System::gps, static_cast<std::uint8_t>(i + 1)};
    m.report = static_cast<std::size_t>(i);
    m.integer = true;
    const double range = 2e7 + 1e5 * i;
    const std::array<double, 2> cycles{100.0 + 7.0 * i, 60.0 - 5.0 * i};
    std::size_t k = 0;
    for (Carrier* c : {&m.first, &m.second}) {
      c->band = k == 0 ? '1' : '2';
      c->frequency = carrier_frequency(System::gps, c->band);
      c->wavelength = speed_of_light / c->frequency;
      c->code = range;
      c->phase = range + cycles[k++] * c->wavelength;
    }
    t.predicted.elevation = 0.8;
    t.predicted.calibrated = true;
    const double mean = m.phase(Combination::range) - range,
                 half = m.phase(Combination::ionosphere);
    state.add(m.satellite, Part::ambiguity, mean + 0.2 * sigma * (i % 3 - 1), sigma);
    state.add(m.satellite, Part::ionosphere_ambiguity, half - 0.2 * sigma * (i % 2), sigma);
    tracked.push_back(t);
    for (const Combination c : {Combination::range, Combination::ionosphere}) {
      Row row;
      row.tracked = tracked.size() - 1;
      row.combination = c;
      row.sigma = 0.3;
      row.variance = 0.09;
      rows.push_back(row);
      row.kind = RowKind::phase;
      rows.push_back(row);
    }
  }
};

TEST_F(IntegerSearch, IntegersAreUsedOnceTheyAreConfirmed) {
  make(0.003, 0.003);
  EXPECT_EQ(resolve(0.0), nullptr);
  EXPECT_EQ(report.outcome, IntegerOutcome::unconfirmed);
  EXPECT_EQ(resolve(29.0), nullptr);
  const FilterState* const fixed = resolve(30.0);
  ASSERT_NE(fixed, nullptr);
  EXPECT_EQ(report.outcome, IntegerOutcome::used);
  EXPECT_EQ(report.used, satellites);
  EXPECT_EQ(marked, satellites);
  EXPECT_LT(fixed->P()(unknown_entry, unknown_entry),
            0.2 * state.P()(unknown_entry, unknown_entry));
}

TEST_F(IntegerSearch, WhatTheSatellitesHaveInCommonIsNoInteger) {
  make(0.003, 0.003);
  for (int i = 0; i < satellites; ++i) shift(i, 0.4, 0.7);
  resolve(0.0);
  ASSERT_NE(resolve(30.0), nullptr);
  EXPECT_EQ(report.used, satellites);
  EXPECT_LT(report.misfit, 1.0);
}

TEST_F(IntegerSearch, AnIntegerThatChangesIsConfirmedAnew) {
  make(0.003, 0.003);
  resolve(0.0);
  ASSERT_NE(resolve(30.0), nullptr);
  shift(3, 1.0, 1.0);  // its wide lane stays
  EXPECT_EQ(resolve(60.0), nullptr);
  EXPECT_EQ(report.outcome, IntegerOutcome::unconfirmed);
  EXPECT_NE(resolve(90.0), nullptr);
}

TEST_F(IntegerSearch, APhaseThatBeginsAnewLeavesTheOthersConfirmed) {
  make(0.003, 0.003);
  resolve(0.0);
  ASSERT_NE(resolve(30.0), nullptr);
  shift(3, 5.0, 5.0);
  for (Row& row : rows) row.new_ambiguity = row.tracked == 3;
  EXPECT_NE(resolve(60.0), nullptr);
}

TEST_F(IntegerSearch, CombinationsAreKnownBeforeSingleAmbiguities) {
  make(0.005, 0.3);
  resolve(0.0);
  const FilterState* const fixed = resolve(30.0);
  ASSERT_NE(fixed, nullptr);
  EXPECT_LT(report.used, satellites);
  EXPECT_LT(fixed->P()(unknown_entry, unknown_entry), state.P()(unknown_entry, unknown_entry));
}

TEST_F(IntegerSearch, UncertainAmbiguitiesHaveNoIntegers) {
  make(0.2, 0.3);
  EXPECT_EQ(resolve(0.0), nullptr);
  EXPECT_EQ(report.outcome, IntegerOutcome::uncertain);
  EXPECT_EQ(report.candidates, satellites - 1);
}

TEST_F(IntegerSearch, AmbiguitiesThatAreNoIntegersDoNotFit) {
  make(0.003, 0.003);
  for (int i = 0; i < satellites; ++i) shift(i, 0.45 * (i % 2), 0.45 * (i % 2));
  EXPECT_EQ(resolve(0.0), nullptr);
  EXPECT_NE(report.outcome, IntegerOutcome::unconfirmed);
}

TEST_F(IntegerSearch, TooFewSatellitesAreNotSearched) {
  make(0.003, 0.003);
  for (Tracked& t : tracked) t.predicted.in_shadow = t.measurement.satellite.number > 4;
  EXPECT_EQ(resolve(0.0), nullptr);
  EXPECT_EQ(report.outcome, IntegerOutcome::too_few);
  EXPECT_EQ(report.candidates, 3);
}

TEST_F(IntegerSearch, MoreSatellitesThanThereIsRoomForAreLeftOut) {
  make(0.003, 0.003);
  const std::vector<Tracked> eight = tracked;
  for (std::uint8_t number = 9; number < 60; ++number) {
    Tracked t = eight.front();
    t.measurement.satellite.number = number;
    state.add(t.measurement.satellite, Part::ambiguity, state.x()[ambiguity(0)], 0.005);
    state.add(t.measurement.satellite, Part::ionosphere_ambiguity, state.x()[ambiguity(0) + 1],
              0.005);
    tracked.push_back(t);
    for (std::size_t k = 0; k < 4; ++k) {
      rows.push_back(rows[k]);
      rows.back().tracked = tracked.size() - 1;
    }
  }
  resolve(0.0);
  EXPECT_NE(resolve(30.0), nullptr);
  EXPECT_EQ(report.candidates, Lambda::max_size / 2 - 1);
}

}  // namespace
}  // namespace maploop::ppp
