// Tests attitudes of ORBEX files: the reader, the nominal attitude against a published one, and
// their use.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "msgs/frames.h"
#include "ppp/gnss_files.h"
#include "ppp/models/attitude.h"
#include "ppp/models/earth.h"
#include "ppp/products/precise.h"
#include "tests/support/real_data.h"

namespace maploop::ppp {
namespace {

const std::string description =
    "%=ORBEX  0.09\n%%\n+FILE/DESCRIPTION\n TIME_SYSTEM         GPS\n FRAME_TYPE          ECEF\n"
    "-FILE/DESCRIPTION\n+EPHEMERIS/DATA\n*ATT RECORDS: ECEF --> SAT. BODY FRAME\n";

// These are four records of CODE's product of 2021, day 210.
const std::string of_code =
    description +
    "## 2021 07 29 00 00 00.000000000000 117\n"
    " ATT G05              4  0.4118416466047115 -0.4208002745788121  0.3515249691235807  "
    "0.7278349971792963\n"
    " ATT R03              4  0.2743828100592047 -0.0058209781494682  0.9464983747007357  "
    "0.1697675364911289\n"
    " ATT E13              4  0.0499005402595386 -0.2277685484909878 -0.7909730445185075 "
    "-0.5656792971686720\n"
    " ATT E36              4  0.1083544413289770  0.2714396260341492  0.1785239746022683 "
    "-0.9395259628956183\n"
    "-EPHEMERIS/DATA\n%END_ORBEX\n";

TEST(Orbex, NominalAttitudeIsThatOfCode) {
  const AttitudeFile file = parse_orbex(of_code, "COM21684.OBX");
  ASSERT_EQ(file.points.size(), 4U);
  Earth earth{std::vector<EarthRotationFile>{}};
  for (const auto& [satellite, points] : file.points) {
    ASSERT_EQ(points.size(), 1U);
    EXPECT_EQ(points[0].time, gps_time({2021, 7, 29, 0, 0, 0.0}));
    const Eigen::Matrix3d R = points[0].R_ecef_body.toRotationMatrix();
    const Eigen::Vector3d place = -26.6e6 * R.col(2);
    const Eigen::Matrix3d nominal = nominal_attitude(place, earth.at(points[0].time).sun);
    const double angle = Eigen::AngleAxisd(nominal.transpose() * R).angle();
    EXPECT_LT(degrees(angle), 0.2) << to_string(satellite);
  }
}

TEST(Orbex, WhatIsDamagedIsNamedOrCounted) {
  const auto with = [](const std::string& what, const std::string& instead) {
    std::string text = of_code;
    return text.replace(text.find(what), what.size(), instead);
  };
  EXPECT_EQ(parse_orbex(with("0.4118416466047115", "0.9118416466047115"), "made").refused, 1);
  EXPECT_THROW(parse_orbex(with("0.4118416466047115", "0.41184?6466047115"), "made"), ReadError);
  EXPECT_THROW(parse_orbex(with("ATT G05              4", "ATT G05              3"), "made"),
               ReadError);
  EXPECT_THROW(parse_orbex(with("          ECEF\n", "          ECI\n"), "made"), ReadError);
  EXPECT_THROW(parse_orbex(with("         GPS\n", "         UTC\n"), "made"), ReadError);
  EXPECT_THROW(parse_orbex(with("## 2021", "*# 2021"), "made"), ReadError);
  EXPECT_THROW(parse_orbex(description, "made"), ReadError);
}

// Returns the nominal attitudes of a satellite in the files' form, every five minutes of an hour.
AttitudeFile nominal_attitudes(const PreciseEphemeris& ephemeris, Satellite satellite,
                               bool inverse) {
  Earth earth{std::vector<EarthRotationFile>{}};
  std::string text = description;
  for (int minute = 0; minute <= 55; minute += 5) {
    const GpsTime t = gps_time({2020, 6, 25, 6, minute, 0.0});
    Eigen::Quaterniond q(nominal_attitude(ephemeris.at(satellite, t)->position, earth.at(t).sun));
    if (!inverse) q = q.conjugate();  // files lead to the body
    text += fmt::format("## 2020 06 25 06 {:02} 0.0 1\n ATT {} 4 {:.16f} {:.16f} {:.16f} {:.16f}\n",
                        minute, to_string(satellite), q.w(), q.x(), q.y(), q.z());
  }
  return parse_orbex(text, "made.obx");
}

TEST(PreciseEphemeris, AttitudesOfFilesAreInterpolatedAndWrongOnesLeftOut) {
  MAPLOOP_REQUIRE_REAL_DATA();
  GnssFiles files;
  for (const char* day : {"176", "177"}) {
    read_into(testing::real_data() /
                  fmt::format("gnss/esbc_static/GRG0MGXFIN_2020{}0000_01D_15M_ORB.SP3.gz", day),
              files);
  }
  const Satellite satellite{System::galileo, 9};
  PreciseEphemeris ephemeris(files.orbits, {}, {});
  const GpsTime between = gps_time({2020, 6, 25, 6, 12, 30.0});
  EXPECT_FALSE(ephemeris.attitude(satellite, between)) << "without files";
  EXPECT_EQ(ephemeris.use_attitudes({nominal_attitudes(ephemeris, satellite, true)}), 12U)
      << "the inverse rotation does not point to the earth";
  EXPECT_FALSE(ephemeris.attitude(satellite, between));

  EXPECT_EQ(ephemeris.use_attitudes({nominal_attitudes(ephemeris, satellite, false)}), 0U);
  const auto known = ephemeris.attitude(satellite, between);
  ASSERT_TRUE(known);
  const Eigen::Matrix3d nominal =
      nominal_attitude(ephemeris.at(satellite, between)->position,
                       Earth(std::vector<EarthRotationFile>{}).at(between).sun);
  EXPECT_LT(degrees(Eigen::AngleAxisd(nominal.transpose() * *known).angle()), 0.02);
  EXPECT_FALSE(ephemeris.attitude(satellite, gps_time({2020, 6, 25, 6, 55, 1.0})));
  EXPECT_FALSE(ephemeris.attitude({System::galileo, 1}, between));
}

}  // namespace
}  // namespace maploop::ppp
