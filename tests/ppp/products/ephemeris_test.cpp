// Compares broadcast and precise ephemerides of one day, which are independent sources.
#include <gtest/gtest.h>

#include <map>

#include "ppp/gnss_files.h"
#include "ppp/products/broadcast.h"
#include "ppp/products/precise.h"
#include "tests/support/real_data.h"

namespace maploop::ppp {
namespace {

const GnssFiles& day() {
  static const GnssFiles files = [] {
    GnssFiles f;
    const auto folder = maploop::testing::real_data() / "gnss/esbc_static";
    for (const char* name :
         {"ESBC00DNK_R_20201770000_01D_MN.rnx.gz", "GRG0MGXFIN_20201760000_01D_15M_ORB.SP3.gz",
          "GRG0MGXFIN_20201770000_01D_15M_ORB.SP3.gz",
          "GRG0MGXFIN_20201770000_01D_30S_CLK.CLK.gz"}) {
      read_into(folder / name, f);
    }
    return f;
  }();
  return files;
}

TEST(Ephemeris, BroadcastIsWithinMetresOfPrecise) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const BroadcastEphemeris broadcast(day().navigation);
  const PreciseEphemeris precise(day().orbits, day().clocks, {});
  std::map<System, int> compared;
  for (int hour = 1; hour < 23; ++hour) {
    const GpsTime t = gps_time({2020, 6, 25, hour, 7, 30.0});
    for (const System system : {System::gps, System::galileo, System::glonass}) {
      for (std::uint8_t n = 1; n < 40; ++n) {
        const auto a = broadcast.at({system, n}, t), b = precise.at({system, n}, t);
        if (!a || !b) continue;
        ++compared[system];
        const double limit = system == System::glonass ? 15.0 : 10.0;
        EXPECT_LT((a->position - b->position).norm(), limit) << to_string({system, n});
        EXPECT_LT((a->velocity - b->velocity).norm(), 0.01) << to_string({system, n});
      }
    }
  }
  EXPECT_GT(compared[System::gps], 100);
  EXPECT_GT(compared[System::galileo], 100);
  EXPECT_GT(compared[System::glonass], 100);
}

TEST(PreciseEphemeris, MeetsItsNodesAndItsVelocityIsItsDerivative) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const PreciseEphemeris precise(day().orbits, day().clocks, {});
  const Satellite satellite{System::galileo, 9};
  const OrbitFile& file = day().orbits[1];
  const auto node = precise.at(satellite, file.epochs[40]);
  ASSERT_TRUE(node);
  EXPECT_LT((node->position - file.points.at(satellite)[40].position).norm(), 1e-4);
  const GpsTime t = file.epochs[40] + std::chrono::seconds(333);
  const auto before = precise.at(satellite, t - std::chrono::milliseconds(500));
  const auto after = precise.at(satellite, t + std::chrono::milliseconds(500));
  const auto now = precise.at(satellite, t);
  ASSERT_TRUE(before && after && now);
  EXPECT_LT((after->position - before->position - now->velocity).norm(), 1e-4);
}

TEST(PreciseEphemeris, ReportsWhatIsMissing) {
  MAPLOOP_REQUIRE_REAL_DATA();
  std::vector<ClockFile> gap = day().clocks;
  auto& points = gap[0].points[{System::galileo, 12}];
  points.erase(points.begin() + 100, points.begin() + 200);
  const PreciseEphemeris precise(day().orbits, gap, {});
  const GpsTime inside = points[100].time - std::chrono::minutes(10);
  EXPECT_FALSE(precise.at({System::galileo, 12}, inside));
  EXPECT_EQ(precise.missing({System::galileo, 12}, inside),
            "no clocks for E12 between 2020-06-25 00:49:30.000 and 2020-06-25 01:40:00.000");
  EXPECT_FALSE(precise.at({System::beidou, 6}, inside));
  EXPECT_FALSE(precise.at({System::gps, 1}, gps_time({2020, 6, 27, 0, 0, 0.0})));
}

TEST(PreciseEphemeris, BiasesAreSubtractedBySignal) {
  SignalBias osb{{System::gps, 5}, "C1C", "", GpsTime::min(), GpsTime::max(), -0.33};
  SignalBias dcb{{System::gps, 6}, "C1W", "C1C", GpsTime::min(), GpsTime::max(), 0.40};
  SignalBias dsb{{System::gps, 7}, "C1C", "C1W", GpsTime::min(), GpsTime::max(), 0.20};
  SignalBias between_bands{{System::gps, 6}, "C1W", "C2W", GpsTime::min(), GpsTime::max(), 2.0};
  BiasFile file;
  file.biases = {osb, dcb, dsb, between_bands};
  const PreciseEphemeris precise({}, {}, {file});
  EXPECT_DOUBLE_EQ(precise.code_bias({System::gps, 5}, '1', 'C', {}), -0.33);
  EXPECT_DOUBLE_EQ(precise.code_bias({System::gps, 5}, '1', 'W', {}), 0.0);
  EXPECT_DOUBLE_EQ(precise.code_bias({System::gps, 6}, '1', 'C', {}), -0.40);
  EXPECT_DOUBLE_EQ(precise.code_bias({System::gps, 7}, '1', 'C', {}), 0.20);
  EXPECT_DOUBLE_EQ(precise.code_bias({System::gps, 6}, '2', 'W', {}), 0.0);
}

TEST(PreciseEphemeris, PhasesHaveBiasesOfTheirOwn) {
  BiasFile file;
  file.biases = {{{System::gps, 5}, "L1C", "", GpsTime::min(), GpsTime::max(), 0.12}};
  const PreciseEphemeris precise({}, {}, {file});
  EXPECT_TRUE(precise.has_phase_biases());
  EXPECT_EQ(precise.phase_bias({System::gps, 5}, '1', 'C', {}), 0.12);
  EXPECT_FALSE(precise.phase_bias({System::gps, 5}, '1', 'W', {}));
  EXPECT_FALSE(precise.phase_bias({System::gps, 6}, '1', 'C', {}));
}

// CNES/CLS add the bias to the wide lane; the clocks contain that of the ionosphere-free phase.
TEST(PreciseEphemeris, WideLanesOfClocksAreBiasesOfPhases) {
  const GpsTime noon = gps_time({2020, 6, 25, 12, 0, 0.0});
  ClockFile file;
  file.wide_lanes = {{{System::galileo, 3}, noon, -0.09}};
  const PreciseEphemeris precise({}, {file}, {});
  const auto b1 = precise.phase_bias({System::galileo, 3}, '1', 'C', noon);
  const auto b2 = precise.phase_bias({System::galileo, 3}, '5', 'Q', noon);
  ASSERT_TRUE(b1 && b2);
  const double f1 = carrier_frequency(System::galileo, '1');
  const double f2 = carrier_frequency(System::galileo, '5');
  EXPECT_NEAR(f1 * f1 * *b1 - f2 * f2 * *b2, 0.0, 1e-12 * f1 * f1);
  EXPECT_NEAR((f1 * *b1 - f2 * *b2) / speed_of_light, 0.09, 1e-12);
  EXPECT_FALSE(precise.phase_bias({System::galileo, 3}, '7', 'Q', noon));
  EXPECT_FALSE(precise.phase_bias({System::galileo, 3}, '1', 'C', noon + std::chrono::hours(13)));
}

}  // namespace
}  // namespace maploop::ppp
