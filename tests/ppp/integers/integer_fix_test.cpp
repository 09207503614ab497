// Tests integer ambiguities on a station's real observations, against its surveyed position.
#include <gtest/gtest.h>

#include <algorithm>

#include "ppp/gnss_files.h"
#include "tests/support/real_data.h"
#include "tools/ppp/run.h"
#include "tools/ppp/score.h"

namespace maploop::ppp {
namespace {

using gnss::Accuracy;

GnssFiles station() {
  GnssFiles files;
  const auto data = maploop::testing::real_data() / "gnss";
  for (const char* name : {"esbc_static/ESBC00DNK_R_20201770000_01D_30S_MO.crx.gz",
                           "esbc_static/GRG0MGXFIN_20201760000_01D_15M_ORB.SP3.gz",
                           "esbc_static/GRG0MGXFIN_20201770000_01D_15M_ORB.SP3.gz",
                           "esbc_static/GRG0MGXFIN_20201770000_01D_30S_CLK.CLK.gz",
                           "models/igs14_rebuilt_GE.atx.gz", "models/igs05_receivers.atx.gz"})
    read_into(data / name, files);
  return files;
}

// The station as a vehicle, with GPS and Galileo, scored one hour after a cold start.
Accuracy drive(const GnssFiles& files, int from, int to, const PppParameters& parameters) {
  gnss::RunOptions options;
  options.parameters = parameters;
  options.parameters.systems = "GE";
  options.start = gps_time({2020, 6, 25, from, 0, 0.0});
  options.end = gps_time({2020, 6, 25, to, 0, 0.0});
  gnss::PppRun run(files, options);
  const gnss::Truth truth("3582104.7678,532590.1740,5232755.1436", *options.start);
  gnss::Score score(truth, 1e-4);
  run.process([&](const PppSolution& s) { score.add(s); });
  return score.accuracy(gps_time({2020, 6, 25, from + 1, 0, 0.0}));
}

TEST(IntegerFix, MakesAStationsPositionsGoodToACentimetre) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const GnssFiles files = station();
  PppParameters real_valued;
  real_valued.integers = false;
  const Accuracy fixed = drive(files, 15, 19, {}), floating = drive(files, 15, 19, real_valued);
  EXPECT_EQ(floating.fixed, 0U);
  EXPECT_GE(fixed.fixed, 355U) << "of 361 epochs";
  EXPECT_EQ(fixed.wrongly_fixed, 0U);
  EXPECT_LT(fixed.horizontal_rmse, 0.011);
  EXPECT_LT(fixed.horizontal_rmse, 0.8 * floating.horizontal_rmse);
  EXPECT_LT(fixed.nees, 3.0);
}

// Real-valued ambiguities take the station 4.5 to 9 minutes at these hours, at which it chose no
// parameter.
TEST(IntegerFix, ADecimetreIsReachedWithinMinutesOfAColdStart) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const GnssFiles files = station();
  const gnss::Truth truth("3582104.7678,532590.1740,5232755.1436",
                          gps_time({2020, 6, 25, 15, 0, 0.0}));
  for (const int hour : {15, 16, 17, 18}) {
    gnss::RunOptions options;
    options.parameters.systems = "GE";
    options.parameters.motion = Motion::fixed;
    options.start = gps_time({2020, 6, 25, hour, 0, 0.0});
    options.end = gps_time({2020, 6, 25, hour, 30, 0.0});
    gnss::PppRun run(files, options);
    gnss::Score score(truth, 1e-4);
    run.process([&](const PppSolution& s) { score.add(s); });
    EXPECT_LE(score.time_to_stay_below(0.1).value_or(1e9), 330.0) << hour;
    EXPECT_EQ(score.accuracy().wrongly_fixed, 0U) << hour;
  }
}

// Satellite antennas that are off by a narrow lane make wrong integers likely: they must be
// refused, or at least not make the position worse.
TEST(IntegerFix, RefusesIntegersOfWrongAntennas) {
  MAPLOOP_REQUIRE_REAL_DATA();
  GnssFiles files = station();
  for (AntennaFile& file : files.antennas) {
    for (Antenna& a : file.antennas) {
      if (!a.satellite) continue;
      for (PhaseCentre& c : a.carriers) c.offset.z() += 0.01 * (a.satellite->number * 7 % 11);
    }
  }
  PppParameters real_valued;
  real_valued.integers = false;
  const Accuracy fixed = drive(files, 15, 19, {}), floating = drive(files, 15, 19, real_valued);
  EXPECT_EQ(fixed.wrongly_fixed, 0U) << "of " << fixed.fixed;
  EXPECT_LT(fixed.horizontal_rmse, 1.1 * floating.horizontal_rmse);
}

TEST(IntegerFix, NeedsBiasesOfPhases) {
  MAPLOOP_REQUIRE_REAL_DATA();
  GnssFiles files = station();
  for (ClockFile& file : files.clocks) file.wide_lanes.clear();
  EXPECT_EQ(drive(files, 15, 17, {}).fixed, 0U);
  const auto lacks = gnss::PppRun(files, {}).setup().missing_models();
  EXPECT_NE(std::find_if(lacks.begin(), lacks.end(),
                         [](const std::string& l) { return l.starts_with("no biases of phases"); }),
            lacks.end());
}

}  // namespace
}  // namespace maploop::ppp
