// Tests forms of navigation files that differ from those of one system's own version.
#include <gtest/gtest.h>

#include <sstream>

#include "ppp/readers/files/navigation.h"
#include "tests/ppp/readers/files/header_record.h"

namespace maploop::ppp {
namespace {

std::string navigation_header(const std::string& first) {
  return maploop::testing::header_record(first, "RINEX VERSION / TYPE") +
         maploop::testing::header_record("", "END OF HEADER");
}

constexpr const char* values_of_version_2 =
    "     .600000000000D+01 -.309062500000D+02  .635312177588D-08 -.102971980168D-01\n"
    "    -.249408185482D-05  .166681586765D+00  .987760722637D-05  .528934096909D+04\n"
    "     .360000000000D+04 -.218674540520D-05  .120675317263D+01 -.242702662945D-05\n"
    "     .883028298199D+00  .178812500000D+03  .176306872373D+01 -.109011683631D-07\n"
    "    -.303584074067D-10  .513000000000D+03  .211400000000D+04  .000000000000D+00\n"
    "     .312000000000D+01  .390000000000D+03 -.512227416039D-08 -.605359673500D-08\n"
    "     .580900000000D+04  .000000000000D+00\n";

// Indents the values as RINEX 3 does.
std::string values_of_version_3() {
  std::istringstream in(values_of_version_2);
  std::string text;
  for (std::string line; std::getline(in, line);) text += ' ' + line + '\n';
  return text;
}

void expect_galileo(const NavigationFile& n) {
  ASSERT_EQ(n.kepler.size(), 1U);
  EXPECT_EQ(n.refused, 0);
  const KeplerMessage& m = n.kepler[0];
  EXPECT_EQ(to_string(m.satellite), "E14");
  EXPECT_EQ(m.toc, gps_time({2020, 7, 12, 1, 0, 0.0}));
  EXPECT_DOUBLE_EQ(m.af0, -.108102580998e-02);
  EXPECT_DOUBLE_EQ(m.sqrt_a, .528934096909e+04);
  EXPECT_DOUBLE_EQ(m.data_sources, 513.0);
  EXPECT_DOUBLE_EQ(m.group_delay[1], -.605359673500e-08);
}

TEST(NavigationForms, Rinex212OfAnotherSystemThanGps) {
  expect_galileo(parse_navigation(
      navigation_header("     2.12           N: GNSS NAV DATA    E: Galileo") +
          "14 20  7 12  1  0  0.0 -.108102580998D-02 -.134150468512D-10  .000000000000D+00\n" +
          values_of_version_2,
      "n.20l"));
}

TEST(NavigationForms, Rinex212WithTheSystemInEachMessage) {
  for (const char* first : {"     2.12           N: GNSS NAV DATA    E: Galileo",
                            "     2.12           N: GNSS NAV DATA    M: Mixed"}) {
    expect_galileo(parse_navigation(
        navigation_header(first) +
            "E14 2020  7 12  1  0  0 -.108102580998D-02 -.134150468512D-10  .000000000000D+00\n" +
            values_of_version_3(),
        "n.nav"));
  }
}

TEST(NavigationForms, MessagesOfSbasAreCountedAndPassedOver) {
  const NavigationFile n = parse_navigation(
      navigation_header("     2.10           H: GEO NAV MSG DATA") +
          "20 20  7 12  1  0  0.0  .000000000000D+00  .000000000000D+00  .345600000000D+06\n"
          "     .212345000000D+05  .000000000000D+00  .000000000000D+00  .000000000000D+00\n"
          "     .363456000000D+05  .000000000000D+00  .000000000000D+00  .327670000000D+05\n"
          "     .000000000000D+00  .000000000000D+00  .000000000000D+00  .120000000000D+02\n",
      "n.20h");
  EXPECT_EQ(n.skipped, 1);
  EXPECT_EQ(n.refused, 0);
  EXPECT_TRUE(n.kepler.empty());
}

TEST(NavigationForms, AMessageOfGlonassMayHaveItsStatusLineInEachVersion) {
  const std::string message =
      "R01 2020 07 12 01 15 00-1.000000000000e-05 0.000000000000e+00 3.600000000000e+03\n"
      "     2.000000000000e+04 1.000000000000e+00 0.000000000000e+00 0.000000000000e+00\n"
      "     1.000000000000e+04 1.000000000000e+00 0.000000000000e+00 1.000000000000e+00\n"
      "     1.200000000000e+04 1.000000000000e+00 0.000000000000e+00 0.000000000000e+00\n";
  const std::string status =
      "     1.790000000000e+02 0.000000000000e+00 0.000000000000e+00 0.000000000000e+00\n";
  for (const std::string version : {"3.04", "3.05"}) {
    for (const std::string& one : {message, message + status}) {
      std::string first = "     ";
      first.append(version).append("           N: GNSS NAV DATA    R: GLONASS");
      std::string text = navigation_header(first);
      text.append(one).append(one);
      const NavigationFile n = parse_navigation(text, "n");
      ASSERT_EQ(n.glonass.size(), 2U) << version;
      EXPECT_EQ(n.glonass[1].position, Eigen::Vector3d(2e7, 1e7, 1.2e7));
      EXPECT_EQ(n.refused, 0);
    }
  }
}

}  // namespace
}  // namespace maploop::ppp
