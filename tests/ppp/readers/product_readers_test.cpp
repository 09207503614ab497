// Navigation, orbits, clocks, antennas, biases, earth rotation and loading: values of real files.
#include <gtest/gtest.h>

#include "ppp/gnss_files.h"
#include "tests/support/real_data.h"

namespace maploop::ppp {
namespace {

GnssFiles read_product(const std::string& name) {
  GnssFiles files;
  read_into(maploop::testing::real_data() / "gnss" / name, files);
  return files;
}

TEST(ProductReaders, OrbitsOfMoreThan99Satellites) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const OrbitFile o =
      read_product("kamakura_kinematic/COD0MGXFIN_20212650000_01D_05M_ORB.SP3.gz").orbits.at(0);
  EXPECT_EQ(o.points.size(), 117U);
  EXPECT_EQ(o.epochs.size(), 289U);
  const auto& point = o.points.at({System::gps, 1}).front();
  EXPECT_DOUBLE_EQ(point.position.x(), -22320914.905);
  EXPECT_NEAR(point.clock, 560.819738e-6, 1e-15);
  EXPECT_EQ(o.points.count({System::qzss, 3}), 1U);
}

TEST(ProductReaders, ClocksOfADay) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const ClockFile c =
      read_product("esbc_static/GRG0MGXFIN_20201770000_01D_30S_CLK.CLK.gz").clocks.at(0);
  EXPECT_EQ(c.points.at({System::galileo, 1}).size(), 2880U);
  EXPECT_DOUBLE_EQ(c.points.at({System::galileo, 1}).front().offset, -0.884707516318e-3);
  EXPECT_EQ(c.refused, 0);
}

TEST(ProductReaders, MessagesOfFiveSystems) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const NavigationFile n =
      read_product("esbc_static/ESBC00DNK_R_20201770000_01D_MN.rnx.gz").navigation.at(0);
  EXPECT_EQ(n.glonass.size(), 510U);
  EXPECT_EQ(n.kepler.size(), 357U + 1602U + 257U + 15U);
  EXPECT_EQ(n.passed_over, 2130);
  EXPECT_EQ(n.refused, 0);
  EXPECT_DOUBLE_EQ(n.klobuchar[0], 4.6566e-09);
}

TEST(ProductReaders, AntennasOfSatellitesAndReceivers) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const AntennaFile satellites =
      read_product("esbc_static/satellites_check_only.atx.gz").antennas.at(0);
  EXPECT_EQ(satellites.antennas.size(), 59U);
  EXPECT_EQ(satellites.antennas.front().satellite, (Satellite{System::gps, 2}));
  EXPECT_DOUBLE_EQ(satellites.antennas.front().carriers.at(0).offset.z(), 0.614);
  const AntennaFile receivers = read_product("models/igs05_receivers.atx.gz").antennas.at(0);
  bool found = false;
  for (const Antenna& a : receivers.antennas) {
    if (a.type != "ASH701945E_M    SCIS") continue;
    found = true;
    EXPECT_FALSE(a.satellite);
    const PhaseCentre* l1 = a.carrier(System::gps, '1');
    ASSERT_NE(l1, nullptr);
    EXPECT_DOUBLE_EQ(l1->offset.z(), 0.08904);
    EXPECT_DOUBLE_EQ(l1->no_azimuth.at(1), -0.00044);
  }
  EXPECT_TRUE(found);
  const AntennaFile damaged = read_product("parser_samples/igs14_small.atx.gz").antennas.at(0);
  EXPECT_EQ(damaged.refused, 2) << "antennas without their end";
  EXPECT_GT(damaged.antennas.size(), 1U);
}

TEST(ProductReaders, BiasesOfCode) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const BiasFile b =
      read_product("kamakura_kinematic/COD0MGXFIN_20212650000_01D_01D_OSB.BIA.gz").biases.at(0);
  const auto at = std::find_if(b.biases.begin(), b.biases.end(), [](const CodeBias& bias) {
    return bias.satellite == Satellite{System::gps, 5} && bias.signal == "C1C";
  });
  ASSERT_NE(at, b.biases.end());
  EXPECT_DOUBLE_EQ(at->metres, -1.1046e-9 * speed_of_light);
  EXPECT_EQ(at->from, gps_time({2021, 9, 22, 0, 0, 0.0}));
}

TEST(ProductReaders, OceanLoadingOfStations) {
  MAPLOOP_REQUIRE_REAL_DATA();
  EXPECT_GT(read_product("models/OLOAD_GO.BLQ.gz").ocean_loading.at(0).stations.size(), 100U);
}

TEST(ProductReaders, DifferentialBiasesAsCodePublishesThem) {
  const std::string text =
      "CODE'S MONTHLY GNSS P1-C1 DCB SOLUTION, YEAR 2020, MONTH 06        07-JUL-20 00:07\n"
      "--------------------------------------------------------------------------------\n\n"
      "DIFFERENTIAL (P1-C1) CODE BIASES FOR SATELLITES AND RECEIVERS:\n\n"
      "PRN / STATION NAME        VALUE (NS)  RMS (NS)\n"
      "***   ****************    *****.***   *****.***\n"
      "G01                          -1.270       0.007\n"
      "R01                           0.500       0.010\n"
      "G     ABMF 97103M001          1.000       0.010\n";
  EXPECT_EQ(file_kind(text), FileKind::dcb);
  const BiasFile b = parse_dcb(text, "P1C1.DCB");
  ASSERT_EQ(b.biases.size(), 2U);
  EXPECT_EQ(b.biases[0].signal, "C1W");
  EXPECT_EQ(b.biases[0].second, "C1C");
  EXPECT_NEAR(b.biases[0].metres, -1.270e-9 * speed_of_light, 1e-12);
  EXPECT_EQ(b.biases[1].signal, "C1P");
  EXPECT_EQ(b.passed_over, 1);
}

TEST(ProductReaders, EarthRotationVersion2) {
  const std::string text =
      "VERSION 2\n EOP  SOLUTION\n"
      "  MJD      Xpole   Ypole  UT1-UTC    LOD  Xsig  Ysig\n"
      "           (10**-6\")     (0.1 usec)\n"
      "59025.50  143212  431321 -2234567    -512    10    10\n";
  EXPECT_EQ(file_kind(text), FileKind::earth_rotation);
  const auto days = parse_erp(text, "igs.erp").days;
  ASSERT_EQ(days.size(), 1U);
  EXPECT_DOUBLE_EQ(days[0].ut1_minus_utc, -0.2234567);
  EXPECT_NEAR(days[0].x_pole, 0.143212 / 206264.806, 1e-12);
}

TEST(ProductReaders, AFileOfNoKindIsNamed) {
  GnssFiles files;
  try {
    parse_into("hello\n", "notes.txt", files);
    FAIL();
  } catch (const ReadError& error) {
    EXPECT_EQ(std::string(error.what()).find("notes.txt: none of RINEX"), 0U);
  }
}

}  // namespace
}  // namespace maploop::ppp
