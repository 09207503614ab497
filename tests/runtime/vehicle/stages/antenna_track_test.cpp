// Tests the motion of the antenna between epochs, by made-up fused states.
#include "runtime/vehicle/stages/antenna_track.h"

#include <gtest/gtest.h>

#include <cmath>

#include "msgs/archive.h"
#include "msgs/frames.h"
#include "ppp/models/geodesy.h"

namespace maploop::vehicle {
namespace {

using Eigen::Vector3d;
using std::chrono::milliseconds;

const Geodetic origin{radians(49.0), radians(8.4), 110.0};

Time at(double seconds) {
  return Time(std::chrono::hours(300'000)) + from_seconds(seconds);
}

// Drives at 10 m/s and turns to the left by `yaw_rate`; the odometry frame is turned by `drift`.
FusedState state(double t, double yaw_rate = 0.0, double drift = 0.0) {
  FusedState s;
  s.status = s.odom.status = NavStatus::aided;
  s.stamp = at(t);
  s.available = s.stamp + milliseconds(1);
  s.origin = origin;
  s.odometry_stamp = s.stamp - milliseconds(200);
  s.covariance(6, 6) = 1e-4;
  const double yaw = yaw_rate * t;
  const double r = 10.0;
  const Vector3d p = std::abs(yaw_rate) > 0.0 ? Vector3d(r / yaw_rate * std::sin(yaw),
                                                         r / yaw_rate * (1.0 - std::cos(yaw)), 0.0)
                                              : Vector3d(r * t, 0.0, 0.0);
  s.attitude = {azimuth_from_yaw(yaw), 0.0, 0.0};
  s.odom.attitude = {azimuth_from_yaw(yaw + drift), 0.0, 0.0};
  s.odom.position = Eigen::AngleAxisd(drift, Vector3d::UnitZ()) * p;
  s.odom.velocity_body = Vector3d(r, 0.0, 0.0);
  s.odom.yaw_rate = yaw_rate;
  return s;
}

fusion::FusionParameters with_lever(double forward) {
  fusion::FusionParameters p;
  p.gnss_lever_forward = forward;
  p.gnss_lever_left = p.gnss_lever_up = 0.0;
  p.gnss_lever_sigma = 0.2;
  return p;
}

Vector3d enu(const Vector3d& earth_fixed) {
  return ppp::rotation_enu_ecef(origin) * earth_fixed;
}

template <class Change>
std::optional<ppp::CarriedMotion> motion_after(AntennaTrack& track, double until, Change change) {
  for (int i = 0; i <= static_cast<int>(100.0 * until); ++i) {
    FusedState s = state(0.01 * i);
    change(s, 0.01 * i);
    track.add(s);
  }
  track.motion_to(at(until - 1.0), at(until + 1.0));
  return track.motion_to(at(until), at(until + 1.0));
}

TEST(AntennaTrack, ADriftOfTheOdometryFrameDoesNotTurnTheMotion) {
  AntennaTrack track(with_lever(0.0));
  const auto motion =
      motion_after(track, 2.0, [](FusedState& s, double t) { s = state(t, 0.0, 0.7); });
  ASSERT_TRUE(motion);
  EXPECT_NEAR(motion->interval, 1.0, 1e-9);
  EXPECT_TRUE(enu(motion->displacement).isApprox(Vector3d(10.0, 0.0, 0.0), 1e-6));
  EXPECT_TRUE(enu(motion->velocity).isApprox(Vector3d(10.0, 0.0, 0.0), 1e-6));
  EXPECT_NEAR(motion->turn_sigma, 0.01, 1e-12);
  EXPECT_EQ(motion->lever_sigma, 0.0);
}

TEST(AntennaTrack, TheAntennaSwingsInATurn) {
  AntennaTrack track(with_lever(2.0));
  constexpr double rate = 0.3;
  const auto motion = motion_after(track, 2.0, [](FusedState& s, double t) { s = state(t, rate); });
  ASSERT_TRUE(motion);
  const auto antenna = [](double t) {
    return Vector3d(10.0 / rate * std::sin(rate * t) + 2.0 * std::cos(rate * t),
                    10.0 / rate * (1.0 - std::cos(rate * t)) + 2.0 * std::sin(rate * t), 0.0);
  };
  EXPECT_LT((enu(motion->displacement) - (antenna(2.0) - antenna(1.0))).norm(), 1e-3);
  EXPECT_NEAR(motion->lever_sigma, 0.2 * rate, 1e-9);
}

TEST(AntennaTrack, AnEpochBetweenTwoStatesIsInterpolated) {
  AntennaTrack track(with_lever(0.0));
  for (int i = 0; i <= 250; ++i) track.add(state(0.01 * i));
  track.motion_to(at(1.003), at(9.0));
  const auto motion = track.motion_to(at(2.008), at(9.0));
  ASSERT_TRUE(motion);
  EXPECT_NEAR(enu(motion->displacement).x(), 10.05, 1e-6);
}

TEST(AntennaTrack, NothingCarriesWithoutASpeedOfItsOwnOrAnAzimuth) {
  for (const int which : {0, 1, 2}) {
    AntennaTrack track(with_lever(0.0));
    const auto motion = motion_after(track, 2.0, [which](FusedState& s, double) {
      if (which == 0) s.odometry_stamp = at(0.0) - milliseconds(600);
      if (which == 1) s.covariance(6, 6) = 0.04;
      if (which == 2) s.odom.status = NavStatus::coasting;
    });
    EXPECT_FALSE(motion) << which;
  }
}

TEST(AntennaTrack, AJumpOfTheFrameIsNoMotion) {
  AntennaTrack track(with_lever(0.0));
  EXPECT_FALSE(motion_after(track, 2.0, [](FusedState& s, double t) {
    if (t > 1.5) s.odom.position.x() += 50.0;
  }));
}

TEST(AntennaTrack, StatesThatAreNotAvailableYetDoNotCount) {
  AntennaTrack track(with_lever(0.0));
  for (int i = 0; i <= 200; ++i) track.add(state(0.01 * i));
  track.motion_to(at(1.0), at(1.2));
  EXPECT_FALSE(track.motion_to(at(2.0), at(1.9)));
}

TEST(AntennaTrack, AnArchiveGoesOnWithTheSameMotion) {
  AntennaTrack track(with_lever(0.0)), resumed(with_lever(0.0));
  for (int i = 0; i <= 200; ++i) track.add(state(0.01 * i));
  track.motion_to(at(1.0), at(1.2));
  ArchiveWriter writer;
  track.archive(writer, at(1.5));
  const Bytes saved = writer.take();
  ArchiveReader reader(saved);
  resumed.archive(reader, Time::max());
  for (int i = 0; i <= 200; ++i)
    if (state(0.01 * i).available > at(1.5)) resumed.add(state(0.01 * i));
  const auto a = track.motion_to(at(2.0), at(2.2)), b = resumed.motion_to(at(2.0), at(2.2));
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->displacement, b->displacement);
}

}  // namespace
}  // namespace maploop::vehicle
