// Tests models against hand-made cases and published values.
#include <gtest/gtest.h>

#include <cmath>

#include "msgs/frames.h"
#include "ppp/models/antenna.h"
#include "ppp/models/atmosphere.h"
#include "ppp/models/attitude.h"
#include "ppp/models/earth.h"
#include "ppp/models/geodesy.h"
#include "ppp/models/tides.h"
#include "ppp/models/troposphere.h"

namespace maploop::ppp {
namespace {

const Eigen::Vector3d esbjerg(3582104.7678, 532590.1740, 5232755.1436);

TEST(Geodesy, ThereAndBack) {
  for (const Geodetic g : {Geodetic{0.9, 0.15, 60.0}, Geodetic{-0.6, -2.0, 8000.0},
                           Geodetic{0.0, 3.1, -50.0}, Geodetic{1.5707, 0.3, 0.0}}) {
    const Geodetic back = geodetic_from_ecef(ecef_from_geodetic(g));
    EXPECT_NEAR(back.latitude, g.latitude, 1e-10);
    EXPECT_NEAR(back.longitude, g.longitude, 1e-10);
    EXPECT_NEAR(back.height, g.height, 1e-3);
  }
}

// The formula of the Astronomical Almanac is good to 0.01 degrees.
TEST(Earth, SunIsWhereTheAlmanacStates) {
  const GpsTime t = gps_time({2020, 6, 25, 12, 0, 18.0});
  Earth earth({});
  const SunAndMoon& now = earth.at(t);
  const double n = 2459026.0 - 2451545.0;  // days since J2000
  const double mean = radians(280.460 + 0.9856474 * n), anomaly = radians(357.528 + 0.9856003 * n);
  const double lambda =
      mean + radians(1.915) * std::sin(anomaly) + radians(0.020) * std::sin(2.0 * anomaly);
  const double obliquity = radians(23.439 - 4e-7 * n);
  const double declination = std::asin(std::sin(obliquity) * std::sin(lambda));
  EXPECT_NEAR(std::asin(now.sun.z() / now.sun.norm()), declination, radians(0.02));
  // At 12:00 UT the sun is over Greenwich, except for the equation of time, -2.6 minutes on that
  // day.
  EXPECT_NEAR(std::atan2(now.sun.y(), now.sun.x()), radians(2.6 / 4.0), radians(0.05));
  EXPECT_NEAR(now.sun.norm(), 1.0164 * 1.495978707e11, 1e8);
  EXPECT_GT(now.moon.norm(), 3.5e8);
  EXPECT_LT(now.moon.norm(), 4.1e8);
}

TEST(Earth, SlowPartsAgreeWithFreshOnes) {
  Earth used({}), fresh({});
  const GpsTime t = gps_time({2020, 6, 25, 12, 0, 0.0});
  used.at(t);
  const SunAndMoon later = used.at(t + std::chrono::seconds(59));
  const SunAndMoon exact = fresh.at(t + std::chrono::seconds(59));
  EXPECT_LT((later.moon - exact.moon).norm() / exact.moon.norm(), 2e-4);
}

TEST(Tides, SolidEarthHasItsSizeAndTwoWavesADay) {
  Earth earth({});
  double low = 1.0, high = -1.0;
  int turns = 0;
  double before = 0.0, slope = 0.0;
  for (int minute = 0; minute < 24 * 60; minute += 10) {
    const SunAndMoon& now =
        earth.at(gps_time({2020, 6, 25, 0, 0, 0.0}) + std::chrono::minutes(minute));
    const double up = solid_earth_tide(esbjerg, now).dot(esbjerg.normalized());
    if (minute > 10 && slope * (up - before) < 0.0) ++turns;
    slope = up - before;
    before = up;
    low = std::min(low, up);
    high = std::max(high, up);
  }
  EXPECT_GT(high - low, 0.10);
  EXPECT_LT(high - low, 0.45);
  EXPECT_GE(turns, 2);
  EXPECT_LE(turns, 4);
}

TEST(Tides, OceanLoadingOfOneConstituentIsItsAmplitude) {
  OceanLoading station;
  station.amplitude[0][0] = 0.010;
  double high = 0.0;
  for (int minute = 0; minute < 13 * 60; minute += 5) {
    const Eigen::Vector3d d = ocean_tide(
        esbjerg, station, gps_time({2020, 6, 25, 0, 0, 0.0}) + std::chrono::minutes(minute));
    const Eigen::Vector3d enu = rotation_enu_ecef(geodetic_from_ecef(esbjerg)) * d;
    high = std::max(high, enu.z());
    EXPECT_NEAR(enu.head<2>().norm(), 0.0, 1e-12);
  }
  EXPECT_NEAR(high, 0.010, 1e-5);
}

// The values are computed by hand from the standard's table at 45 degrees, on its coldest day and
// half a year later.
TEST(Atmosphere, DelaysFollowLatitudeSeasonAndHeight) {
  const GpsTime winter = gps_time({2020, 1, 28, 0, 0, 0.0}),
                summer = gps_time({2020, 7, 28, 0, 0, 0.0});
  const Geodetic sea{radians(45.0), 0.0, 0.0};
  EXPECT_NEAR(zenith_delay(sea, winter).hydrostatic, 0.0022768 * 1018.0, 1e-4);
  const double exponent = 9.784 * (2.11 + 1.0) - 5.26e-3 * 287.054;
  EXPECT_NEAR(zenith_delay(sea, winter).wet, 0.382 * 287.054 / exponent * 4.42 / 272.15, 1e-6);
  EXPECT_GT(zenith_delay(sea, summer).wet, 3.0 * zenith_delay(sea, winter).wet);
  EXPECT_NEAR(zenith_delay({-sea.latitude, 0.0, 0.0}, summer).wet, zenith_delay(sea, winter).wet,
              0.002)
      << "the other hemisphere's winter";
  const Geodetic mountain{radians(45.0), 0.0, 2000.0};
  EXPECT_NEAR(zenith_delay(mountain, winter).hydrostatic / zenith_delay(sea, winter).hydrostatic,
              std::exp(-2000.0 / 7900.0), 0.01);
  EXPECT_LT(zenith_delay(mountain, winter).wet, 0.6 * zenith_delay(sea, winter).wet);
}

// This is the test case of the IERS Conventions (2010) for GMF: Green Bank on 2009-08-12.
TEST(Troposphere, MappingIsThatOfTheConventions) {
  const GlobalMapping mapping({0.6708665767, -1.393397187, 844.715},
                              gps_time({2009, 8, 12, 0, 0, 0.0}));
  const Mapping at = mapping.at(radians(90.0) - 1.278564131);
  EXPECT_NEAR(at.hydrostatic, 3.425245519339138678, 1e-11);
  EXPECT_NEAR(at.wet, 3.449589116182419257, 1e-11);
}

TEST(Troposphere, MappingIsOneAtTheZenithOnBothHemispheres) {
  for (const double latitude : {-90.0, -45.0, 0.0, 64.92, 90.0}) {
    const GlobalMapping mapping({radians(latitude), 2.0, 0.0}, gps_time({2020, 4, 9, 0, 0, 0.0}));
    EXPECT_NEAR(mapping.at(radians(90.0)).hydrostatic, 1.0, 1e-9);
    EXPECT_NEAR(mapping.at(radians(90.0)).wet, 1.0, 1e-9);
    EXPECT_NEAR(mapping.at(radians(30.0)).hydrostatic, 1.994, 3e-3);
    EXPECT_GT(mapping.at(radians(5.0)).wet, mapping.at(radians(5.0)).hydrostatic);
  }
}

TEST(Antenna, OffsetUpShortensTheRangeAtTheZenith) {
  Antenna antenna;
  antenna.zenith_last = 90.0;
  PhaseCentre carrier;
  carrier.offset = {0.0, 0.0, 0.1};
  carrier.no_azimuth.assign(19, 0.0);
  antenna.carriers.push_back(carrier);
  EXPECT_DOUBLE_EQ(receiver_phase_centre(antenna, System::gps, '1', {0, 0, 1}), -0.1);
  EXPECT_NEAR(receiver_phase_centre(antenna, System::gps, '1', {0, 1, 0}), 0.0, 1e-12);
  antenna.carriers[0].offset = {0.02, 0.0, 0.0};  // north
  EXPECT_NEAR(receiver_phase_centre(antenna, System::gps, '1', {0, 1, 0}), -0.02, 1e-12);
}

TEST(Antenna, VariationIsInterpolatedInBothAngles) {
  Antenna antenna;
  antenna.zenith_last = 10.0;
  antenna.zenith_step = 10.0;
  antenna.azimuth_step = 180.0;
  PhaseCentre carrier;
  carrier.no_azimuth = {0.0, 0.0};
  carrier.azimuths = {{0.0, 0.002}, {0.0, 0.004}, {0.0, 0.002}};
  EXPECT_NEAR(phase_variation(antenna, carrier, radians(5.0), radians(90.0)), 0.0015, 1e-12);
  EXPECT_NEAR(phase_variation(antenna, carrier, radians(60.0), radians(-90.0)), 0.003, 1e-12);
}

TEST(WindUp, ATurnOfTheSatelliteIsACycle) {
  const Eigen::Vector3d satellite = esbjerg.normalized() * 26.6e6;
  const Eigen::Matrix3d R_enu_ecef = rotation_enu_ecef(geodetic_from_ecef(esbjerg));
  const Eigen::Matrix3d start = nominal_attitude(satellite, {1.5e11, 0, 0});
  const double first = wind_up(start, R_enu_ecef, satellite - esbjerg, 0.0);
  double cycles = first;
  for (int step = 1; step <= 36; ++step) {
    const Eigen::Matrix3d turned =
        start * Eigen::AngleAxisd(radians(10.0 * step), Eigen::Vector3d::UnitZ());
    cycles = wind_up(turned, R_enu_ecef, satellite - esbjerg, cycles);
  }
  EXPECT_NEAR(std::abs(cycles - first), 1.0, 1e-9);
}

TEST(Attitude, SolarPanelsAreAcrossTheSun) {
  const Eigen::Vector3d satellite(2e7, 1.5e7, 0.5e7), sun(1e11, -1e11, 3e10);
  const Eigen::Matrix3d R = nominal_attitude(satellite, sun);
  EXPECT_NEAR(R.determinant(), 1.0, 1e-12);
  EXPECT_NEAR(R.col(1).dot((sun - satellite).normalized()), 0.0, 1e-9);
  EXPECT_GT(R.col(0).dot(sun), 0.0);
  EXPECT_TRUE(in_shadow(-2.6e7 * sun.normalized(), sun));
  EXPECT_FALSE(in_shadow(2.6e7 * sun.normalized(), sun));
}

// A file of satellites only goes before a general one, and a later beginning before an earlier.
TEST(SatelliteAntennas, OfSeveralTheRightOneIsUsed) {
  const Satellite satellite{System::gps, 18};
  const auto antenna = [&](int from, int until) {
    Antenna a;
    a.satellite = satellite;
    a.valid_from = gps_time({from, 1, 1, 0, 0, 0.0});
    a.valid_until = until > 0 ? gps_time({until, 1, 1, 0, 0, 0.0}) : GpsTime::max();
    return a;
  };
  AntennaFile old, recent, special;
  old.antennas = {antenna(1993, 0)};
  recent.antennas = {antenna(2001, 2019)};
  special.antennas = {antenna(1990, 0)};
  special.satellites_only = true;
  const GpsTime t = gps_time({2018, 6, 1, 0, 0, 0.0}), later = gps_time({2020, 6, 1, 0, 0, 0.0});
  const std::vector<AntennaFile> general{old, recent}, all{old, special, recent};
  EXPECT_EQ(SatelliteAntennas(general, t).of(satellite), &general[1].antennas[0]);
  EXPECT_EQ(SatelliteAntennas(general, later).of(satellite), nullptr)
      << "the old file does not know that the number is another satellite's";
  EXPECT_EQ(SatelliteAntennas(all, later).of(satellite), &all[1].antennas[0]);
  EXPECT_EQ(SatelliteAntennas(general, gps_time({1992, 1, 1, 0, 0, 0.0})).of(satellite), nullptr);
}

}  // namespace
}  // namespace maploop::ppp
