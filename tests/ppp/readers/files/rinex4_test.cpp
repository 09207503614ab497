// Tests the readers on RINEX 4, made from real files of RINEX 3 by what differs between them.
#include <gtest/gtest.h>

#include <map>
#include <sstream>

#include "ppp/gnss_files.h"
#include "tests/support/real_data.h"

namespace maploop::ppp {
namespace {

const char* const navigation_of_a_day = "gnss/esbc_static/ESBC00DNK_R_20201770000_01D_MN.rnx.gz";

std::string with_version(std::string text, const std::string& version) {
  return text.replace(5, 4, version);
}

// Returns the kind of message that RINEX 4 names. Galileo's is told by its data sources, which the
// sixth line contains.
std::string message_of(char system, const std::string& sixth_line) {
  if (system == 'R') return "FDMA";
  if (system == 'S') return "SBAS";
  if (system == 'C') return "D1";
  if (system != 'E') return "LNAV";
  return sixth_line.substr(23, 19) == " 2.580000000000e+02" ? "FNAV" : "INAV";
}

// Writes the messages of RINEX 3 as records of RINEX 4, with others between them.
std::string as_version_4(const std::string& text) {
  std::istringstream in(text);
  std::string line, header, body;
  while (std::getline(in, line) && line.find("END OF HEADER") == line.npos) {
    if (line.find("IONOSPHERIC CORR") == line.npos) header += line + '\n';
  }
  header += line + '\n';
  std::vector<std::string> message;
  const auto finish = [&] {
    if (message.empty()) return;
    const char system = message[0][0];
    const std::string sixth = message.size() > 5 ? message[5] : std::string{};
    body += "> EPH " + message[0].substr(0, 3) + ' ' + message_of(system, sixth) + '\n';
    for (const std::string& l : message) body += l + '\n';
    message.clear();
  };
  while (std::getline(in, line)) {
    if (!line.empty() && line[0] != ' ') finish();
    message.push_back(line);
  }
  finish();
  return with_version(header, "4.00") +
         "> STO G   LNAV\n    2020 06 25 00 00 00 GPUT\n"
         "     4.000000000000e+05 0.000000000000e+00 0.000000000000e+00 0.000000000000e+00\n"
         "\n"
         "> ION G12 LNAV\n"
         "    2020 06 25 01 00 00 4.656600000000e-09 1.490100000000e-08-5.960500000000e-08\n"
         "    -1.192100000000e-07 8.192000000000e+04 9.830400000000e+04-6.553600000000e+04\n"
         "    -5.242900000000e+05 0.000000000000e+00\n"
         "> ION E01 IFNV\n"
         "    2020 06 25 02 00 00 2.825000000000e+01 7.812500000000e-03 1.007100000000e-02\n"
         "     0.000000000000e+00\n"
         "> ION C20 CNVX\n"
         "    2020 06 25 02 00 00 1.0 2.0 3.0\n"
         "> EPH G01 CNV2\n"
         "    not read\n" +
         body;
}

TEST(Rinex4, NavigationHasTheMessagesOfVersion3) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const std::string text = read_file(testing::real_data() / navigation_of_a_day);
  const NavigationFile three = parse_navigation(text, "three"),
                       four = parse_navigation(as_version_4(text), "four");
  ASSERT_EQ(four.kepler.size(), three.kepler.size());
  for (std::size_t i = 0; i < three.kepler.size(); ++i) {
    const KeplerMessage &a = three.kepler[i], &b = four.kepler[i];
    ASSERT_EQ(a.satellite, b.satellite);
    ASSERT_EQ(a.toe, b.toe);
    ASSERT_EQ(a.i_dot, b.i_dot);
    ASSERT_EQ(a.data_sources, b.data_sources);
    ASSERT_EQ(a.group_delay, b.group_delay);
  }
  ASSERT_EQ(four.glonass.size(), three.glonass.size());
  EXPECT_EQ(four.glonass.back().position, three.glonass.back().position);
  EXPECT_EQ(four.skipped, three.skipped + 3) << "STO, BeiDou's ionosphere and CNAV-2";
  EXPECT_EQ(four.refused, three.refused);
}

TEST(Rinex4, CoefficientsOfTheIonosphereHaveTheirTime) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const NavigationFile n =
      parse_navigation(as_version_4(read_file(testing::real_data() / navigation_of_a_day)), "four");
  ASSERT_EQ(n.ionosphere.size(), 2U);
  EXPECT_EQ(n.ionosphere[0].coefficients,
            IonosphereCoefficients(Klobuchar{{4.6566e-9, 1.4901e-8, -5.9605e-8, -1.1921e-7,
                                              8.1920e4, 9.8304e4, -6.5536e4, -5.2429e5}}));
  EXPECT_EQ(n.ionosphere[0].first, gps_time({2020, 6, 25, 1, 0, 0.0}));
  EXPECT_EQ(n.ionosphere[1].coefficients,
            IonosphereCoefficients(IonisationLevel{{28.25, 7.8125e-3, 1.0071e-2}}));
  EXPECT_EQ(n.ionosphere[1].last, gps_time({2020, 6, 25, 2, 0, 0.0}));
}

TEST(Rinex4, NavigationThatIsCutOrHasNoRecordIsRefused) {
  const std::string header =
      "     4.01           NAVIGATION DATA     M                   RINEX VERSION / TYPE\n"
      "                                                            END OF HEADER       \n";
  EXPECT_EQ(parse_navigation(header + "> EPH G01 LNAV\n", "cut").refused, 1);
  EXPECT_EQ(
      parse_navigation(header + "> ION E01 IFNV\n    2020 06 25 02 00 00 2.825", "cut").refused, 1);
  EXPECT_THROW(parse_navigation(header + "G01 2020 06 25 00 00 00\n", "three"), ReadError);
  EXPECT_THROW(parse_navigation(with_version(header, "4.10"), "later"), ReadError);
}

TEST(Rinex4, ObservationsAreThoseOfVersion3) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const std::string text =
      read_file(testing::real_data() / "gnss/kamakura_kinematic/SEPT265G.21O.gz");
  const Observations three = parse_observations(text, "three"),
                     four = parse_observations(with_version(text, "4.02"), "four");
  ASSERT_EQ(four.epochs.size(), three.epochs.size());
  EXPECT_EQ(four.epochs.back().time, three.epochs.back().time);
  EXPECT_EQ(four.epochs.back().signals.size(), three.epochs.back().signals.size());
}

}  // namespace
}  // namespace maploop::ppp
