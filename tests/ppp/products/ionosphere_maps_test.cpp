// Tests the reader of IONEX and the interpolation of its maps.
#include "ppp/products/ionosphere_maps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "msgs/frames.h"
#include "ppp/gnss_files.h"
#include "tests/ppp/made_ionex.h"

namespace maploop::ppp {
namespace {

using testing::ionex;
using testing::MadeMaps;

const GpsTime midnight = gps_time({2020, 6, 25, 0, 0, 0.0}) + std::chrono::seconds(18);  // UTC

IonosphereMapFile parsed(const MadeMaps& made) {
  return parse_ionex(ionex(made), "made.20i");
}

TEST(Ionex, GridMapsAndValuesWithoutAny) {
  MadeMaps made;
  made.electrons = [](double latitude, double longitude, int hour) {
    return latitude == 0.0 && longitude == 0.0 ? std::nan("") : 20.0 + 0.1 * latitude + hour;
  };
  const IonosphereMapFile file = parsed(made);
  EXPECT_EQ(file.latitude.count, 71);
  EXPECT_EQ(file.longitude.count, 73);
  ASSERT_EQ(file.maps.size(), 13U);
  EXPECT_EQ(file.maps[1].time, midnight + std::chrono::hours(2));
  EXPECT_FLOAT_EQ(file.maps[0].electrons[0], 28.8F) << "28.75, rounded";
  EXPECT_TRUE(std::isnan(file.maps[0].electrons[35 * 73 + 36]));
  EXPECT_FLOAT_EQ(file.maps[3].sigma.at(7), 1.5F);
}

TEST(Ionex, WhatIsDamagedIsNamed) {
  const std::string text = ionex({});
  const auto error_of = [](const std::string& damaged) {
    try {
      parse_ionex(damaged, "made.20i");
    } catch (const ReadError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  const auto with = [&](const std::string& what, const std::string& instead) {
    std::string damaged = text;
    return damaged.replace(damaged.find(what), what.size(), instead);
  };
  const auto cut = [&](const std::string& before) { return text.substr(0, text.rfind(before)); };
  EXPECT_NE(error_of(cut("   -80.0-180.0")).find("ends inside a map"), std::string::npos);
  EXPECT_NE(error_of(text.substr(0, text.size() - 81)).find("is cut"), std::string::npos);
  EXPECT_NE(error_of(text.substr(0, 200)).find("inside its header"), std::string::npos);
  EXPECT_NE(error_of(with("  87.5 -87.5  -2.5", "  87.5 -87.5   0.0")).find("step"),
            std::string::npos);
  EXPECT_NE(error_of(with(" 450.0 450.0   0.0", " 450.0 550.0  50.0")).find("several heights"),
            std::string::npos);
  EXPECT_NE(error_of(with("  85.0-180.0", "  84.0-180.0")).find("latitude"), std::string::npos);
  EXPECT_NE(error_of(with("     1.0", "     2.0")).find("version"), std::string::npos);
}

TEST(IonosphereMaps, BetweenNodesAndTurningWithTheSun) {
  // The ionosphere is fixed to the sun: its only change is that the earth turns below it.
  MadeMaps made;
  made.electrons = [](double latitude, double longitude, int hour) {
    return 30.0 + 0.1 * latitude + 10.0 * std::cos(radians(longitude + 15.0 * hour - 210.0));
  };
  const std::vector<IonosphereMapFile> files{parsed(made)};
  const IonosphereMaps maps(files);
  for (const double hours : {0.0, 1.0, 3.3, 23.9}) {
    for (const double longitude : {-179.0, -3.3, 0.0, 8.4, 179.9, 365.0}) {
      const auto electrons =
          maps.at({radians(49.0), radians(longitude)}, midnight + from_seconds(3600.0 * hours));
      ASSERT_TRUE(electrons);
      // The grid's rounding to 0.1 TECU, and the chord of a cosine over five degrees.
      EXPECT_NEAR(electrons->value,
                  30.0 + 4.9 + 10.0 * std::cos(radians(longitude + 15.0 * hours - 210.0)), 0.08);
      EXPECT_DOUBLE_EQ(electrons->sigma, 1.5);
    }
  }
}

TEST(IonosphereMaps, NothingWhereThereIsNoValue) {
  MadeMaps made;
  made.electrons = [](double latitude, double, int) { return latitude < 0.0 ? NAN : 20.0; };
  made.sigma = {};
  const std::vector<IonosphereMapFile> files{parsed(made)};
  const IonosphereMaps maps(files);
  const PiercePoint here{radians(49.0), radians(8.4)};
  EXPECT_TRUE(maps.at(here, midnight));
  EXPECT_DOUBLE_EQ(maps.at(here, midnight)->sigma, 5.0) << "what maps usually have";
  EXPECT_TRUE(maps.at({0.0, 0.0}, midnight)) << "a node of the grid itself";
  EXPECT_FALSE(maps.at({radians(-1.0), 0.0}, midnight)) << "beside nodes without a value";
  EXPECT_FALSE(maps.at({radians(88.0), 0.0}, midnight)) << "beyond the grid";
  EXPECT_FALSE(maps.at(here, midnight - std::chrono::seconds(1)));
  EXPECT_FALSE(maps.at(here, midnight + std::chrono::hours(24) + std::chrono::seconds(1)));
}

TEST(IonosphereMaps, DelayIsThatOfTheElectronsAndTheSlant) {
  const IonosphericDelay zenith =
      ionospheric_delay(VerticalElectrons{10.0, 2.0, 7}, std::numbers::pi / 2.0);
  EXPECT_NEAR(zenith.value, 1.6237, 1e-4) << "0.162 m for each TECU on GPS L1";
  EXPECT_NEAR(zenith.sigma, 0.3247, 1e-4);
  EXPECT_EQ(zenith.source, 7U);
  const IonosphericDelay low = ionospheric_delay(VerticalElectrons{10.0, 2.0, 7}, radians(10.0));
  EXPECT_NEAR(low.value / zenith.value, ionospheric_slant(radians(10.0)), 1e-9);
}

}  // namespace
}  // namespace maploop::ppp
