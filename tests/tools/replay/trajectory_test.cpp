#include "tools/replay/run_pass.h"

#include <gtest/gtest.h>

namespace maploop::tools {
namespace {

using std::chrono::milliseconds;

constexpr Time start = from_nanoseconds(1'317'042'651'000'000'000);
constexpr double speed = 20.0;     // m/s
constexpr double yaw_rate = 0.01;  // rad/s

RelativeMotion motion(int from_ms, int to_ms, OdometryStatus status) {
  RelativeMotion m;
  m.from = start + milliseconds(from_ms);
  m.stamp = start + milliseconds(to_ms);
  m.status = status;
  const double dt = to_seconds(m.stamp - m.from);
  m.translation = {speed * dt, 0.0, 0.0};
  m.rotation = Eigen::AngleAxisd(yaw_rate * dt, Eigen::Vector3d::UnitZ());
  return m;
}

// The truth moves as if all motions were measured; those from 5 to 6 s get the status `in_between`.
Accuracy score_with(OdometryStatus in_between) {
  TrajectoryCollector collector;
  std::map<Time, Eigen::Isometry3d> truth;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int ms = 0; ms < 12000; ms += 100) {
    const bool measured = ms < 5000 || ms >= 6000;
    const RelativeMotion step = motion(ms, ms + 100, OdometryStatus::ok);
    pose = pose * step.T_from_to();
    truth[step.stamp] = pose;
    collector.add(measured ? step : motion(ms, ms + 100, in_between));
  }
  return *collector.score([&](Time t) { return std::optional(truth.at(t)); },
                          Eigen::Isometry3d::Identity());
}

TEST(TrajectoryCollector, GoesOnAsItWentThroughRefusedMotions) {
  EXPECT_LT(score_with(OdometryStatus::ok).raw.end_point_m, 1e-6);
  EXPECT_LT(score_with(OdometryStatus::too_few_features).raw.end_point_m, 1e-6);
}

}  // namespace
}  // namespace maploop::tools
