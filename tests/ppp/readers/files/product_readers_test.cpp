// Tests the readers of navigation, orbits, clocks, antennas, biases, earth rotation and loading
// with values of real files.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>

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
  EXPECT_EQ(n.skipped, 2130);
  EXPECT_EQ(n.refused, 0);
  ASSERT_EQ(n.ionosphere.size(), 2U);
  const auto& gps = std::get<Klobuchar>(n.ionosphere[0].coefficients).values;
  EXPECT_DOUBLE_EQ(gps[0], 4.6566e-09);
  EXPECT_DOUBLE_EQ(gps[7], -5.2429e+05);
  const auto& galileo = std::get<IonisationLevel>(n.ionosphere[1].coefficients).values;
  EXPECT_EQ(galileo, (std::array{2.8250e+01, 7.8125e-03, 1.0071e-02}));
  EXPECT_GT(n.ionosphere[0].first, gps_time({2020, 6, 24, 19, 0, 0.0}));
  EXPECT_LT(n.ionosphere[0].first, gps_time({2020, 6, 25, 0, 30, 0.0}));
  EXPECT_GT(n.ionosphere[0].last, gps_time({2020, 6, 25, 23, 0, 0.0}));
  EXPECT_LT(n.ionosphere[0].last, gps_time({2020, 6, 26, 4, 0, 0.0}));
}

// The header is of RINEX 2, which has its own labels; some coefficients are impossible.
TEST(ProductReaders, IonosphereOfAnOldHeader) {
  const std::string before =
      "     2.11           N: GPS NAV DATA                         RINEX VERSION / TYPE\n";
  const std::string beta =
      "    0.9011D+05  0.1638D+05 -0.1311D+06 -0.6554D+05          ION BETA            \n";
  const std::string behind =
      "                                                            END OF HEADER       \n"
      " 6 20  7 12  2  0  0.0-0.839701388031D-03-0.165982783074D-10 0.000000000000D+00\n"
      "    0.910000000000D+02 0.934062500000D+02 0.116040547840D-08 0.162092304801D+00\n"
      "    0.484101474285D-05 0.626740418375D-02 0.652112066746D-05 0.515365489006D+04\n"
      "    0.720000000000D+04-0.242143869400D-07 0.329237003460D+00-0.596046447754D-07\n"
      "    0.111541663136D+01 0.326593750000D+03 0.206958726335D+01-0.638312302555D-08\n"
      "    0.307155651409D-09 0.000000000000D+00 0.211400000000D+04 0.000000000000D+00\n"
      "    0.000000000000D+00 0.000000000000D+00 0.000000000000D+00 0.910000000000D+02\n"
      "    0.406800000000D+06 0.000000000000D+00\n";
  const auto read = [&](const std::string& alpha) {
    return parse_navigation(before + alpha + beta + behind, "old.20n");
  };
  const NavigationFile n =
      read("    0.1025D-07  0.7451D-08 -0.5960D-07 -0.5960D-07          ION ALPHA           \n");
  ASSERT_EQ(n.kepler.size(), 1U);
  ASSERT_EQ(n.ionosphere.size(), 1U);
  EXPECT_EQ(n.ionosphere[0].coefficients,
            IonosphereCoefficients(Klobuchar{{0.1025e-7, 0.7451e-8, -0.5960e-7, -0.5960e-7,
                                              0.9011e5, 0.1638e5, -0.1311e6, -0.6554e5}}));
  EXPECT_EQ(n.ionosphere[0].first, n.kepler[0].toe);
  EXPECT_TRUE(
      read("    0.1025D+07  0.7451D-08 -0.5960D-07 -0.5960D-07          ION ALPHA           \n")
          .ionosphere.empty());
  const auto of_version = [&](const std::string& version) {
    std::string text = before + behind;
    return parse_navigation(text.replace(5, 4, version), "old.20n");
  };
  EXPECT_EQ(of_version("2.00").kepler.size(), 1U);
  EXPECT_THROW(of_version("2.13"), ReadError);
}

TEST(ProductReaders, AntennasOfSatellitesAndReceivers) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const AntennaFile satellites = read_product("models/igs14_rebuilt_GE.atx.gz").antennas.at(0);
  EXPECT_TRUE(satellites.satellites_only);
  EXPECT_EQ(satellites.antennas.front().satellite, (Satellite{System::gps, 1}));
  EXPECT_DOUBLE_EQ(satellites.antennas.front().carriers.at(0).offset.z(), 1.5018);
  const AntennaFile receivers = read_product("models/igs05_receivers.atx.gz").antennas.at(0);
  EXPECT_FALSE(receivers.satellites_only);
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
  const auto at = std::find_if(b.biases.begin(), b.biases.end(), [](const SignalBias& bias) {
    return bias.satellite == Satellite{System::gps, 5} && bias.signal == "C1C";
  });
  ASSERT_NE(at, b.biases.end());
  EXPECT_DOUBLE_EQ(at->metres, -1.1046e-9 * speed_of_light);
  EXPECT_EQ(at->from, gps_time({2021, 9, 22, 0, 0, 0.0}));
}

TEST(ProductReaders, BiasesOfPhases) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const BiasFile b =
      read_product("kamakura_kinematic/COD0MGXFIN_20212650000_01D_01D_OSB.BIA.gz").biases.at(0);
  const auto at = std::find_if(b.biases.begin(), b.biases.end(), [](const SignalBias& bias) {
    return bias.satellite == Satellite{System::galileo, 1} && bias.signal == "L5Q";
  });
  ASSERT_NE(at, b.biases.end());
  EXPECT_DOUBLE_EQ(at->metres, 1.21097e-9 * speed_of_light);
}

TEST(ProductReaders, BiasesOfPhasesInCyclesArePassedOver) {
  const std::string text =
      "%=BIA 1.00 COD 2021:274:20048 MGX 2021:265:00000 2021:266:00000 A 00000002\n"
      "+BIAS/SOLUTION\n"
      " OSB  G063 G01           C1C       2021:265:00000 2021:266:00000 ns                 -1.4777 "
      "  "
      "   0.0062\n"
      " OSB  G063 G01           L1C       2021:265:00000 2021:266:00000 cyc                 0.2500 "
      "  "
      "   0.0062\n"
      "-BIAS/SOLUTION\n";
  const BiasFile b = parse_bias_sinex(text, "cycles.BIA");
  ASSERT_EQ(b.biases.size(), 1U);
  EXPECT_EQ(b.biases[0].signal, "C1C");
  EXPECT_EQ(b.skipped, 1);
}

TEST(ProductReaders, WideLanesOfCnesClocks) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const ClockFile c =
      read_product("esbc_static/GRG0MGXFIN_20201770000_01D_30S_CLK.CLK.gz").clocks.at(0);
  const auto at = std::find_if(c.wide_lanes.begin(), c.wide_lanes.end(), [](const auto& w) {
    return w.satellite == Satellite{System::gps, 2};
  });
  ASSERT_NE(at, c.wide_lanes.end());
  EXPECT_DOUBLE_EQ(at->cycles, -1.257);
  EXPECT_EQ(at->time, gps_time({2020, 6, 25, 12, 0, 0.0}));
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
  EXPECT_EQ(b.skipped, 1);
}

TEST(ProductReaders, OtherCompressionsThanGzipAreNamed) {
  for (const std::string start : {"PK\3\4....", "\x1f\x9d\x90...."}) {
    GnssFiles files;
    try {
      parse_into(start, "a.zip", files);
      FAIL();
    } catch (const ReadError& error) {
      EXPECT_NE(std::string(error.what()).find("unpack it"), std::string::npos) << error.what();
    }
  }
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

std::string line(std::string text, const std::string& label) {
  text.resize(60, ' ');
  return text + label + "\n";
}

// Makes an antenna with `rows` rows of azimuths `step` degrees apart, for zenith angles 0 and 5.
std::string antex(double step, int rows, const std::string& behind = "") {
  std::array<char, 16> dazi{};
  std::snprintf(dazi.data(), dazi.size(), "  %6.1f", step);
  std::string text =
      line("     1.4            M", "ANTEX VERSION / SYST") + line("A", "PCV TYPE / REFANT") +
      line("", "END OF HEADER") + line("", "START OF ANTENNA") +
      line("TRM59800.00     NONE", "TYPE / SERIAL NO") + line(dazi.data(), "DAZI") +
      line("     0.0   5.0   5.0", "ZEN1 / ZEN2 / DZEN") + line("   G01", "START OF FREQUENCY") +
      line("      1.00      0.00     80.00", "NORTH / EAST / UP") + "   NOAZI    0.00    1.00\n";
  for (int i = 0; i < rows; ++i) text += "     0.0    0.00    1.00\n";
  return text + line("   G01", "END OF FREQUENCY") + behind + line("", "END OF ANTENNA");
}

std::string antex_refusal(const std::string& text) {
  try {
    parse_antex(text, "a.atx");
  } catch (const ReadError& error) {
    return error.what();
  }
  return {};
}

TEST(ProductReaders, AnAntennasStepOfAzimuthsFitsTheCircle) {
  EXPECT_EQ(antex_refusal(antex(90.0, 5)), "");
  EXPECT_EQ(antex_refusal(antex(180.0, 3)), "");
  EXPECT_NE(antex_refusal(antex(720.0, 1)).find("a.atx:6: an azimuth step"), std::string::npos);
  EXPECT_NE(antex_refusal(antex(90.0, 5, line("     0.0", "DAZI")))
                .find("DAZI or ZEN1 comes after a carrier"),
            std::string::npos);
}

TEST(ProductReaders, AnAntennaIsASatellitesByItsSerialNumberWithoutARadome) {
  const auto satellite = [](const std::string& columns) {
    std::string text = antex(90.0, 5);
    const std::string receiver = "TRM59800.00     NONE";
    text.replace(text.find(receiver), columns.size(), columns);
    return parse_antex(text, "a.atx").antennas.at(0).satellite;
  };
  const Satellite g05{System::gps, 5};
  EXPECT_EQ(satellite("BLOCK IIR-M         G05                 G050      2009-043A "), g05);
  EXPECT_EQ(satellite("BLOCK IIR-M         G05                                     "), g05);
  EXPECT_EQ(satellite("A TYPE OF 20 COLUMNSG05                 G050      2009-043A "), g05);
  EXPECT_EQ(satellite("SIMULATED GALILEO   G05                                     "), g05);
  EXPECT_EQ(satellite("TRM59800.00     NONEG05                                     "),
            std::nullopt);
  EXPECT_EQ(satellite("TRM59800.00     NONE                                        "),
            std::nullopt);
}

TEST(ProductReaders, AntexIsReadFromVersion12To14) {
  const auto refusal = [](const std::string& version) {
    std::string text = antex(90.0, 5);
    return antex_refusal(text.replace(text.find("1.4"), 3, version));
  };
  for (const char* version : {"1.2", "1.3", "1.4"}) EXPECT_EQ(refusal(version), "") << version;
  for (const char* version : {"1.1", "1.5"}) {
    EXPECT_NE(refusal(version).find("ANTEX 1.2 to 1.4"), std::string::npos) << version;
  }
}

TEST(ProductReaders, OrbitFilesWithTooManyEmptyEpochsAreRefused) {
  std::string satellites = "+  594   ", epochs;
  for (int i = 0; i < 594; ++i) {
    std::array<char, 8> name{};
    std::snprintf(name.data(), name.size(), "%c%02d", "GRECJI"[i / 99], 1 + i % 99);
    if (i > 0 && i % 17 == 0) satellites += "\n+        ";
    satellites += name.data();
  }
  for (int i = 0; i < 2000; ++i) {
    std::array<char, 40> line{};
    std::snprintf(line.data(), line.size(), "*  2020  6 25 %2d %2d %2d.00000000\n", i / 3600,
                  i / 60 % 60, i % 60);
    epochs += line.data();
  }
  const std::string text =
      "#dP2020  6 25  0  0  0.00000000      96 ORBIT IGS14 HLM  IGS\n"
      "## 2111 345600.00000000   900.00000000 59025 0.0000000000000\n" +
      satellites + "\n%c M  cc GPS ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc\n" + epochs;
  try {
    parse_sp3(text, "a.sp3");
    FAIL();
  } catch (const ReadError& error) {
    EXPECT_NE(std::string(error.what()).find("too short for its epochs of"), std::string::npos)
        << error.what();
  }
}

TEST(ProductReaders, AFileOfUnknownFormatIsNamed) {
  GnssFiles files;
  try {
    parse_into("hello\n", "notes.txt", files);
    FAIL();
  } catch (const ReadError& error) {
    EXPECT_EQ(std::string(error.what()).find("notes.txt: not in a known format"), 0U);
  }
}

}  // namespace
}  // namespace maploop::ppp
