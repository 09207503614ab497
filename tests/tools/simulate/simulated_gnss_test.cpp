// Tests the simulated satellites with the readers and models of ppp, and signals in simple scenes.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "msgs/frames.h"
#include "ppp/gnss_files.h"
#include "ppp/models/troposphere.h"
#include "ppp/products/broadcast.h"
#include "ppp/products/precise.h"
#include "tools/simulate/gnss/atmosphere.h"
#include "tools/simulate/gnss/product_text.h"
#include "tools/simulate/gnss/signal_paths.h"
#include "tools/simulate/gnss/tracking.h"

namespace maploop::simulate {
namespace {

const ProductSpan span{ppp::from_utc(parse_time("2026-05-04 08:00:00.0")), 600.0};

TEST(SimulatedConstellation, VelocityIsThatOfThePosition) {
  const Constellation sky(60.0, 1);
  ASSERT_EQ(sky.satellites().size(), 54U);
  for (const TrueSatellite& s : sky.satellites()) {
    const double h = 0.1;
    const Eigen::Vector3d numeric =
        (s.orbit.position(30.0 + h) - s.orbit.position(30.0 - h)) / (2.0 * h);
    EXPECT_LT((numeric - s.orbit.velocity(30.0)).norm(), 1e-4);
  }
}

// The products of a constellation, read by the readers.
struct Products {
  explicit Products(const Constellation& sky, std::uint64_t seed) {
    parse_into(navigation_text(sky, span, seed), "nav", files);
    parse_into(orbit_text(sky, span, seed), "sp3", files);
    parse_into(clock_text(sky, span, seed), "clk", files);
    parse_into(antenna_text(sky), "atx", files);
  }
  ppp::GnssFiles files;
};

TEST(SimulatedProducts, AreNearTheTruthByTheErrorsTheyShouldHave) {
  const Constellation sky(span.seconds, 1);
  const Products products(sky, 1);
  const ppp::BroadcastEphemeris broadcast(products.files.navigation);
  const ppp::PreciseEphemeris precise(products.files.orbits, products.files.clocks, {});
  double broadcast_squares = 0.0, precise_squares = 0.0, clock_squares = 0.0, count = 0.0;
  for (std::size_t i = 0; i < sky.satellites().size(); ++i) {
    const TrueSatellite& s = sky.satellites()[i];
    for (double t = 7.3; t < span.seconds; t += 101.0) {
      const ppp::GpsTime now = span.start + from_seconds(t);
      const auto said = broadcast.at(s.satellite, now);
      const auto final = precise.at(s.satellite, now);
      ASSERT_TRUE(said && final) << to_string(s.satellite);
      const Eigen::Vector3d truth = s.orbit.position(t);
      const double clock = sky.clock(i, t) + clock_relativity(s.orbit, t);
      // A message refers to the phase centre, which is about a metre nearer to the earth.
      const Eigen::Vector3d centre = truth - s.antennas[0].phase_centre * truth.normalized();
      broadcast_squares += (said->position - centre).squaredNorm();
      precise_squares += (final->position - truth).squaredNorm();
      clock_squares += std::pow(ppp::speed_of_light * (final->clock - clock), 2);
      EXPECT_LT(ppp::speed_of_light * std::fabs(said->clock - clock), 2.0);
      EXPECT_LT((final->velocity - s.orbit.velocity(t)).norm(), 1e-3);
      count += 1.0;
    }
  }
  EXPECT_NEAR(std::sqrt(broadcast_squares / count), 1.1, 0.5);
  EXPECT_NEAR(std::sqrt(precise_squares / count), 0.021, 0.006);
  EXPECT_NEAR(std::sqrt(clock_squares / count), 0.016, 0.005);
}

TEST(SimulatedAir, TracedRaysAgreeWithTheMappingFunction) {
  const Geodetic site{radians(49.0), radians(8.4), 115.0};
  const ppp::GlobalMapping mapping(site, span.start);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Troposphere air(site.height, seed);
    const double zenith = air.zenith_delay(0.0);
    EXPECT_GT(zenith, 2.25);
    EXPECT_LT(zenith, 2.65);
    for (const double elevation : {7.0, 15.0, 30.0, 60.0}) {
      // The mean of two opposite directions contains no gradient.
      const double delay = 0.5 * (air.delay(radians(elevation), 0.3, 0.0) +
                                  air.delay(radians(elevation), 0.3 + radians(180.0), 0.0));
      EXPECT_NEAR(delay / zenith / mapping.at(radians(elevation)).hydrostatic, 1.0, 0.006)
          << elevation;
    }
  }
}

TEST(SimulatedIonosphere, IsThickerByDayAndLowOnTheSky) {
  const Geodetic site{radians(49.0), radians(8.4), 115.0};
  const Ionosphere day(site, 13.0 * 3600.0, 1), night(site, 1.0 * 3600.0, 1);
  EXPECT_GT(day.electrons(1.5, 0.0, 0.0), 1.5 * night.electrons(1.5, 0.0, 0.0));
  EXPECT_GT(night.electrons(1.5, 0.0, 0.0), 1.0);
  EXPECT_GT(day.electrons(0.3, 0.0, 0.0), 1.6 * day.electrons(1.5, 0.0, 0.0));
  EXPECT_NEAR(ionospheric_delay(10.0, 1575.42e6), 1.62, 0.01);
}

// A wall 10 m east of the antenna, 30 m high.
class WallToTheEast : public ::testing::Test {
 protected:
  static Mesh wall() {
    Mesh mesh;
    const std::uint32_t brick = mesh.add({Material::brick, 0.3F, 3});
    mesh.add_quad({10, -60, 0}, {10, 60, 0}, {10, 60, 30}, {10, -60, 30}, brick);
    return mesh;
  }
  static Eigen::Vector3d sky(double azimuth, double elevation) {
    const double a = radians(azimuth), e = radians(elevation);
    return {std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e)};
  }

  World world_{wall(), {}};
  RayScene scene_{world_};
};

TEST_F(WallToTheEast, ReflectsWhatComesFromTheWest) {
  const Eigen::Vector3d velocity(-2.0, 5.0, 0.0);
  const SignalPaths around(scene_, {0, 0, 1.7}, velocity);
  const auto paths = around.from(sky(270.0, 30.0));
  ASSERT_EQ(paths.size(), 2U);
  EXPECT_EQ(paths[0].surface, 0U);
  EXPECT_EQ(paths[0].amplitude, 1.0);
  EXPECT_EQ(paths[0].delay, 0.0);
  EXPECT_NE(paths[1].surface, 0U);
  EXPECT_NEAR(paths[1].delay, 2.0 * 10.0 * std::cos(radians(30.0)), 1e-3);
  EXPECT_LT(paths[1].amplitude, 0.6);
  // The rate agrees with the change of the delay after the antenna has moved.
  const SignalPaths later(scene_, Eigen::Vector3d(0, 0, 1.7) + 0.1 * velocity, velocity);
  const auto moved = later.from(sky(270.0, 30.0));
  ASSERT_EQ(moved.size(), 2U);
  EXPECT_NEAR((moved[1].delay - paths[1].delay) / 0.1, paths[1].rate, 1e-3);
  EXPECT_EQ(moved[1].surface, paths[1].surface);
}

TEST_F(WallToTheEast, BlocksTheEastAndBendsAtItsTop) {
  const SignalPaths around(scene_, {0, 0, 1.7}, Eigen::Vector3d::Zero());
  EXPECT_TRUE(around.from(sky(90.0, 30.0)).empty());
  const auto below = around.from(sky(90.0, 69.0));  // the top is at 70.5 degrees
  ASSERT_EQ(below.size(), 1U);
  EXPECT_LT(below[0].amplitude, 0.3);
  EXPECT_GT(below[0].amplitude, 0.02);
  EXPECT_LT(below[0].delay, 0.05);
  EXPECT_EQ(around.from(sky(90.0, 75.0)).at(0).amplitude, 1.0);
}

TEST(SignalTracker, AFreeSignalIsMeasuredToItsNoise) {
  SignalTracker tracker({1575.42e6, 293.05, 0.1, 50.0}, 1, 1);
  const std::vector<SignalPath> free{SignalPath{}};
  double squares = 0.0, first_phase = 0.0;
  ASSERT_FALSE(tracker.track(free, 1.2, 1.0)->phase) << "phase comes an epoch later";
  const auto second = tracker.track(free, 1.2, 1.0);
  ASSERT_TRUE(second && second->phase);
  EXPECT_TRUE(second->lost_lock);
  first_phase = *second->phase;
  for (int i = 0; i < 500; ++i) {
    const auto now = tracker.track(free, 1.2, 1.0);
    ASSERT_TRUE(now && now->phase);
    EXPECT_FALSE(now->lost_lock);
    EXPECT_LT(std::fabs(*now->phase - first_phase), 0.015);
    EXPECT_NEAR(now->cn0, 50.0, 4.0);
    squares += now->code * now->code;
  }
  EXPECT_NEAR(std::sqrt(squares / 500.0), 0.16, 0.05);
}

TEST(SignalTracker, AReflectionPullsTheCodeEitherWayAndAloneTakesItAlong) {
  const SignalShape shape{1575.42e6, 293.05, 0.1, 50.0};
  const double wavelength = ppp::speed_of_light / shape.frequency;
  const auto mean_code = [&](const std::vector<SignalPath>& paths) {
    SignalTracker tracker(shape, 1, 1);
    double sum = 0.0;
    for (int i = 0; i < 200; ++i) sum += tracker.track(paths, 1.2, 1.0)->code / 200.0;
    return sum;
  };
  // A path delayed by more than half the spacing shifts the code by its amplitude times that half.
  const double in_phase = 105.0 * wavelength;
  const SignalPath direct{1.0}, reflected{0.3, in_phase, 0.0, 0.0, 9};
  const SignalPath against{0.3, in_phase + 0.5 * wavelength, 0.0, 0.0, 9};
  EXPECT_NEAR(mean_code({direct, reflected}), 0.3 * 0.5 * 0.1 * 293.05, 0.5);
  EXPECT_NEAR(mean_code({direct, against}), -0.3 * 0.5 * 0.1 * 293.05, 0.5);
  EXPECT_NEAR(mean_code({reflected}), in_phase, 0.3);
  EXPECT_FALSE(SignalTracker(shape, 1, 1).track({}, 1.2, 1.0).has_value());
}

}  // namespace
}  // namespace maploop::simulate
