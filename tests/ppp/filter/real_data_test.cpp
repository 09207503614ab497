// Tests the filter on real observations, against surveyed truth.
#include <gtest/gtest.h>

#include <algorithm>

#include "ppp/gnss_files.h"
#include "tests/support/broken_archives.h"
#include "tests/support/real_data.h"
#include "tools/ppp/run.h"
#include "tools/ppp/score.h"

namespace maploop::ppp {
namespace {

using gnss::Accuracy;
using gnss::PppRun;
using gnss::RunOptions;
using gnss::Score;
using gnss::Truth;
using std::chrono::seconds;

const std::string esbjerg = "3582104.7678,532590.1740,5232755.1436";

GnssFiles folder(const std::string& name) {
  GnssFiles files;
  const auto data = maploop::testing::real_data() / "gnss";
  for (const auto& entry : std::filesystem::directory_iterator(data / name)) {
    const std::string file = entry.path().filename();
    // These are results of other programs, the base station of a pair, and antennas that are not
    // those of the products.
    if (file.find("check_only") != std::string::npos || file.find(".pos") != std::string::npos ||
        file.find(".conf") != std::string::npos || file.find(".csv") != std::string::npos ||
        file.starts_with("3034265G")) {
      continue;
    }
    read_into(entry.path(), files);
  }
  read_into(data / "models/igs14_rebuilt_GE.atx.gz", files);
  read_into(data / "models/igs05_receivers.atx.gz", files);
  return files;
}

// The ionosphere is that of 17 days earlier, because the drive's own navigation file has none.
const GnssFiles& riverside_drive() {
  static const GnssFiles files = [] {
    GnssFiles read = folder("riverside_drive");
    read_into(
        maploop::testing::real_data() / "gnss/esbc_static/ESBC00DNK_R_20201770000_01D_MN.rnx.gz",
        read);
    return read;
  }();
  return files;
}

const GnssFiles& station() {
  static const GnssFiles files = folder("esbc_static");
  return files;
}

Accuracy score(const GnssFiles& files, const RunOptions& options, const std::string& truth_text,
               double skip_seconds, std::optional<double>* below = nullptr) {
  PppRun run(files, options);
  const GpsTime first = files.observations.at(0).epochs.front().time;
  const Truth truth(truth_text, first);
  Score result(truth, 1e-4);
  run.process([&](const PppSolution& s) { result.add(s); });
  if (below) *below = result.time_to_stay_below(0.1);
  return result.accuracy(first + from_seconds(skip_seconds));
}

RunOptions hours(int from, int to, Motion motion, const std::string& systems) {
  RunOptions options;
  options.parameters.motion = motion;
  options.parameters.systems = systems;
  options.start = gps_time({2020, 6, 25, from, 0, 0.0});
  options.end = gps_time({2020, 6, 25, to, 0, 0.0});
  return options;
}

TEST(PppFilter, StaticStationToCentimetres) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const Accuracy a = score(station(), hours(0, 6, Motion::fixed, "GRE"), esbjerg, 2 * 3600.0);
  EXPECT_EQ(a.solved, a.with_truth);
  EXPECT_LT(a.horizontal_rmse, 0.02);
  EXPECT_LT(a.up_rmse, 0.025);
  EXPECT_LT(a.nees, 4.0) << "3 where the covariance is right";
}

TEST(PppFilter, StationAsAVehicleToCentimetres) {
  MAPLOOP_REQUIRE_REAL_DATA();
  RunOptions options = hours(0, 24, Motion::kinematic, "GRE");
  options.end = gps_time({2020, 6, 25, 23, 40, 0.0});  // orbits end soon after
  const Accuracy a = score(station(), options, esbjerg, 3600.0);
  EXPECT_EQ(a.solved, a.with_truth);
  EXPECT_LT(a.horizontal_rmse, 0.021);
  EXPECT_LT(a.up_rmse, 0.027);
}

// Without each of the models, the static position changes.
TEST(PppFilter, EveryModelMatters) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const RunOptions whole = hours(0, 4, Motion::fixed, "GE");
  const auto error = [&](auto&& change) {
    RunOptions options = whole;
    change(options.models);
    const Accuracy a = score(station(), options, esbjerg, 2 * 3600.0);
    return std::hypot(a.horizontal_rmse, a.up_rmse);
  };
  const double with_all = error([](Models&) {});
  EXPECT_GT(error([](Models& m) { m.satellite_antenna = false; }), 1.5 * with_all);
  EXPECT_GT(error([](Models& m) { m.solid_tide = false; }), 3.0 * with_all);
}

TEST(PppFilter, ACarInAStreetIsFollowed) {
  MAPLOOP_REQUIRE_REAL_DATA();
  RunOptions options;
  options.parameters.systems = "GE";
  const auto truth = maploop::testing::real_data() / "gnss/kamakura_kinematic/rtk_reference.pos.gz";
  const Accuracy a = score(folder("kamakura_kinematic"), options, truth.string(), 120.0);
  EXPECT_EQ(a.solved, a.with_truth);
  EXPECT_LT(a.horizontal_rmse, 0.49);
  EXPECT_LT(a.horizontal_rmse_without_mean, 0.15);
  EXPECT_LT(a.up_rmse, 0.49);
  EXPECT_LT(a.nees, 4.0);
}

TEST(PppFilter, OneFrequencyWithBroadcastOrbits) {
  MAPLOOP_REQUIRE_REAL_DATA();
  RunOptions options;
  options.parameters.systems = "GEC";
  const auto truth = maploop::testing::real_data() / "gnss/riverside_drive/groundtruth.csv.gz";
  const Accuracy a = score(riverside_drive(), options, truth.string(), 0.0);
  EXPECT_GE(a.coverage(), 0.99);
  EXPECT_LT(a.horizontal_rmse, 0.245);
  EXPECT_LT(a.horizontal_rmse_without_mean, 0.185);
  EXPECT_LT(std::abs(a.mean_enu.y()), 0.10) << "the ionosphere is thicker to the south";
  EXPECT_LT(a.up_rmse, 0.42);
  EXPECT_LT(a.nees, 3.0);
}

// Then the whole ionosphere is estimated, and not only its difference from a model.
TEST(PppFilter, ReportsMissingIonosphericCoefficientsOnOneFrequency) {
  MAPLOOP_REQUIRE_REAL_DATA();
  RunOptions options;
  options.parameters.systems = "GEC";
  const auto truth = maploop::testing::real_data() / "gnss/riverside_drive/groundtruth.csv.gz";
  const GnssFiles files = folder("riverside_drive");
  const PppRun run(files, options);
  const auto& missing = run.setup().missing_models();
  EXPECT_TRUE(std::any_of(missing.begin(), missing.end(), [](const std::string& line) {
    return line.find("no ionospheric coefficients") != std::string::npos;
  }));
  const Accuracy a = score(files, options, truth.string(), 0.0);
  EXPECT_LT(a.horizontal_rmse, 0.33);
  EXPECT_LT(a.up_rmse, 0.60);
  EXPECT_LT(a.nees, 3.0);
}

// When satellites return, the position is a hundred metres off, and with it the residuals of all
// codes.
TEST(PppFilter, BehindATunnelAtSpeedItIsFoundAgainAtOnce) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const GnssFiles& files = riverside_drive();
  const GpsTime first = files.observations.at(0).epochs.front().time;
  RunOptions options;
  options.parameters.systems = "GEC";
  options.start = first + seconds(1800);
  options.end = first + seconds(2700);
  options.parameters.bridged_sigma = 0.0;  // only measured positions are scored
  constexpr int tunnel = 45;               // s
  options.change = [&](Epoch& epoch) {
    const Duration since = epoch.time - first;
    if (since >= seconds(2400) && since < seconds(2400 + tunnel)) epoch.satellites.clear();
  };
  const auto truth = maploop::testing::real_data() / "gnss/riverside_drive/groundtruth.csv.gz";
  const Accuracy a = score(files, options, truth.string(), 2400.0);
  EXPECT_EQ(a.solved, a.with_truth - tunnel);
  EXPECT_LT(a.horizontal_rmse, 1.3);
  EXPECT_LT(a.nees, 6.0);
}

TEST(PppFilter, GoesOnFromAnArchiveWithTheSameBits) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const GnssFiles& files = station();
  const PreciseEphemeris ephemeris(files.orbits, files.clocks, files.biases);
  RangeInputs inputs;
  inputs.ephemeris = &ephemeris;
  inputs.antennas = &files.antennas;
  PppParameters parameters;
  PppFilter filter(parameters, inputs, Earth({})), resumed(parameters, inputs, Earth({}));
  const auto& epochs = files.observations.at(0).epochs;
  for (std::size_t i = 0; i < 60; ++i) filter.process(epochs[i]);
  const Bytes archive = maploop::testing::saved(filter);
  maploop::testing::load(archive, resumed);
  for (std::size_t i = 60; i < 120; ++i) {
    const PppSolution a = filter.process(epochs[i]);
    const PppSolution& b = resumed.process(epochs[i]);
    ASSERT_EQ(a.position, b.position) << i;
    ASSERT_EQ(a.covariance, b.covariance) << i;
  }
  maploop::testing::expect_refuses_broken(archive, resumed);
  parameters.code_sigma *= 2.0;
  PppFilter other(parameters, inputs, Earth({}));
  EXPECT_NE(maploop::testing::refusal(archive, other).find("code_sigma"), std::string::npos);
}

TEST(PppFilter, ACodeThatIsFarOffIsRefusedWithItsReason) {
  MAPLOOP_REQUIRE_REAL_DATA();
  GnssFiles files = station();
  Epoch& epoch = files.observations[0].epochs[120];
  const SatelliteSignals victim = epoch.satellites.at(18);
  for (std::uint32_t k = 0; k < victim.count; ++k) epoch.signals[victim.first + k].code += 500.0;
  PppRun run(files, hours(0, 2, Motion::fixed, "GRE"));
  int refused = 0;
  run.process([&](const PppSolution& s) {
    if (s.time != epoch.time) return;
    for (const SatelliteReport& r : s.satellites) {
      if (r.satellite == victim.satellite) {
        EXPECT_EQ(r.refused, PppRefusal::code_far) << to_string(r.satellite);
        ++refused;
      }
    }
    EXPECT_NE(s.status, PppStatus::none);
  });
  EXPECT_EQ(refused, 1);
}

TEST(PppFilter, StartsAgainAndReportsItWhenThePositionIsWrong) {
  MAPLOOP_REQUIRE_REAL_DATA();
  GnssFiles files = station();
  // From one epoch on, the station is 50 km away: its observations are those of noon.
  auto& epochs = files.observations[0].epochs;
  for (std::size_t i = 60; i < 90; ++i) {
    const GpsTime t = epochs[i].time;
    epochs[i] = epochs[i + 1400];
    epochs[i].time = t;
  }
  PppRun run(files, hours(0, 2, Motion::fixed, "G"));
  int without = 0;
  bool recovered = false;
  run.process([&](const PppSolution& s) {
    if (s.status == PppStatus::none) {
      ++without;
      EXPECT_FALSE(s.message.empty());
    }
    recovered = s.status != PppStatus::none;
  });
  EXPECT_GT(without, 0);
  EXPECT_TRUE(recovered);
}

TEST(PppRun, ReportsWhatIsMissing) {
  MAPLOOP_REQUIRE_REAL_DATA();
  GnssFiles none;
  EXPECT_THROW(PppRun(none, {}), std::runtime_error);
  GnssFiles files = folder("kamakura_kinematic");
  files.orbits.clear();
  files.navigation.clear();
  try {
    const PppRun run(files, {});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("no orbits: add an SP3"), std::string::npos);
  }
}

}  // namespace
}  // namespace maploop::ppp
