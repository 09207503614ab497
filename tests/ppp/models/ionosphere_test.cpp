// Tests the ionosphere's models against published values, and the choice of coefficients for a
// moment.
#include "ppp/models/ionosphere.h"

#include <gtest/gtest.h>

#include <cmath>

#include "msgs/frames.h"
#include "ppp/models/geodesy.h"
#include "ppp/products/ionosphere.h"
#include "ppp/satellite.h"

namespace maploop::ppp {
namespace {

using std::chrono::hours;

const GpsTime noon = gps_time({2020, 7, 12, 12, 0, 0.0});
const Klobuchar gps{
    {4.6566e-9, 1.4901e-8, -5.9605e-8, -1.1921e-7, 8.1920e4, 9.8304e4, -6.5536e4, -5.2429e5}};
const IonisationLevel galileo{{28.25, 7.8125e-3, 1.0071e-2}};

TEST(Klobuchar, NightIsFiveNanosecondsTimesSlant) {
  const Klobuchar k{{1e-8, 0, 0, 0, 9e4, 0, 0, 0}};
  const double zenith =
      ionospheric_delay(k, {0.6, 0.0, 0.0}, 0.0, radians(90.0), gps_time({2020, 6, 25, 0, 0, 0.0}));
  EXPECT_NEAR(zenith, 5e-9 * speed_of_light, 0.01);
}

// This is the example by which implementations of the model are commonly compared.
TEST(Klobuchar, AnAfternoonInNebraska) {
  const Klobuchar k{{3.82e-8, 1.49e-8, -1.79e-7, 0.0, 1.43e5, 0.0, -3.28e5, 1.13e5}};
  const double delay = ionospheric_delay(k, {radians(40.0), radians(-100.0), 0.0}, radians(210.0),
                                         radians(20.0), gps_time({2000, 1, 2, 20, 45, 0.0}));
  EXPECT_NEAR(delay, 23.784, 1e-3);
}

// These are test vectors of the model's description, for high, medium and low solar activity.
TEST(NtcmG, ElectronsOfItsDescription) {
  struct Vector {
    IonisationLevel level;
    int hour;                                   // UTC, of day 105
    std::array<double, 3> receiver, satellite;  // degrees east and north, m
    double electrons;                           // TECU
  };
  const IonisationLevel much{{236.831641, -0.39362878, 0.00402826613}},
      medium{{121.129893, 0.351254133, 0.0134635348}},
      little{{2.580271, 0.127628236, 0.0252748384}};
  for (const Vector& v :
       {Vector{much, 0, {-62.34, 82.49, 78.11}, {8.23, 54.29, 20281546.18}, 33.7567},
        Vector{much, 20, {-52.81, 5.25, -25.76}, {10.94, 44.72, 20450566.19}, 252.0204},
        Vector{medium, 4, {40.19, -3.00, -23.32}, {107.19, -10.65, 19943686.06}, 108.8940},
        Vector{medium, 16, {115.89, -31.80, 12.78}, {124.09, -14.31, 20100697.90}, 15.0902},
        Vector{little, 0, {141.13, 39.14, 117.00}, {165.14, -13.93, 20181976.50}, 51.5270},
        Vector{little, 20, {-155.46, 19.80, 3754.69}, {-82.52, 20.64, 19937791.48}, 67.4750}}) {
    const auto geodetic = [](const std::array<double, 3>& p) {
      return Geodetic{radians(p[1]), radians(p[0]), p[2]};
    };
    const Geodetic site = geodetic(v.receiver);
    const Eigen::Vector3d ray =
        rotation_enu_ecef(site) *
        (ecef_from_geodetic(geodetic(v.satellite)) - ecef_from_geodetic(site)).normalized();
    const double delay =
        ionospheric_delay(v.level, site, std::atan2(ray.x(), ray.y()), std::asin(ray.z()),
                          gps_time({2021, 4, 15, v.hour, 0, 18.0}));
    EXPECT_NEAR(delay / (40.3e16 / std::pow(1575.42e6, 2)), v.electrons, 2e-4);
  }
}

TEST(BroadcastIonosphere, TakesTheNearestAndReportsHowFarItIs) {
  BroadcastIonosphere ionosphere;
  EXPECT_FALSE(ionosphere.at(noon));
  Klobuchar other = gps;
  other.values[0] *= 2.0;
  ionosphere.add({gps, noon - hours(48), noon - hours(24)});
  ionosphere.add({other, noon + hours(30), noon + hours(31)});
  auto nearest = ionosphere.at(noon);
  ASSERT_TRUE(nearest);
  EXPECT_EQ(nearest->coefficients, IonosphereCoefficients(gps));
  EXPECT_EQ(nearest->age, hours(24));
  // The same coefficients are sent again: their period is extended.
  ionosphere.add({gps, noon - hours(1), noon - hours(1)});
  nearest = ionosphere.at(noon - hours(12));
  ASSERT_TRUE(nearest);
  EXPECT_EQ(nearest->age, Duration::zero());
  nearest = ionosphere.at(noon + hours(29));
  ASSERT_TRUE(nearest);
  EXPECT_EQ(nearest->coefficients, IonosphereCoefficients(other));
  EXPECT_FALSE(ionosphere.at(noon + BroadcastIonosphere::longest_age + hours(32)));
}

TEST(BroadcastIonosphere, PrefersGalileosOfTheDay) {
  BroadcastIonosphere ionosphere;
  ionosphere.add({gps, noon, noon});
  ionosphere.add({galileo, noon - hours(20), noon - hours(20)});
  EXPECT_EQ(ionosphere.at(noon)->coefficients, IonosphereCoefficients(galileo));
  EXPECT_EQ(ionosphere.at(noon + hours(24 * 5))->coefficients, IonosphereCoefficients(gps));
}

TEST(BroadcastIonosphere, UncertaintyGrowsWithTheDaysAndTheUsualLevelIsTheMostUncertain) {
  BroadcastIonosphere ionosphere;
  ionosphere.add({gps, noon, noon});
  const Geodetic site{0.6, -2.0, 300.0};
  const auto at = [&](GpsTime t) {
    return ionospheric_delay(ionosphere.at(t), site, 1.0, radians(40.0), t);
  };
  const IonosphericDelay now = at(noon), later = at(noon + hours(24 * 17)),
                         none = at(noon + hours(24 * 90 + 8));  // noon there
  EXPECT_DOUBLE_EQ(now.sigma, 0.5 * now.value);
  EXPECT_GT(later.sigma / later.value, 0.55);
  // 63.7 solar flux units: some metres by day.
  EXPECT_GT(none.value, 2.0);
  EXPECT_LT(none.value, 12.0);
  EXPECT_DOUBLE_EQ(none.sigma, 0.7 * none.value);
  EXPECT_EQ(ionosphere_lack(ionosphere.age(noon + hours(20))), "");
  EXPECT_NE(ionosphere_lack(ionosphere.age(noon + hours(24 * 17))).find("17 days"),
            std::string::npos);
  EXPECT_NE(ionosphere_lack(ionosphere.age(noon + hours(24 * 90))).find("usual level"),
            std::string::npos);
}

}  // namespace
}  // namespace maploop::ppp
