// The filter against odometry alone on recorded drives. The parameters are the defaults, chosen
// from the physics; the odometry's nominal noise is one figure for all drives.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/estimators/fusion/filter_run.h"
#include "tests/estimators/fusion/recorded_drive.h"
#include "tests/estimators/fusion/synthetic_drive.h"
#include "tests/estimators/fusion/trajectory_score.h"
#include "tests/support/real_data.h"

namespace maploop::fusion {
namespace {

using namespace maploop::testing;

struct Comparison {
  double length = 0.0;                                 // m
  double end_fused = 0.0, end_odometry = 0.0;          // m, horizontal
  SegmentError fused, odometry;                        // 100 m
  double heading_fused = 0.0, heading_odometry = 0.0;  // deg rms against truth
  NavState last;
};

Comparison compare(const RecordedDrive& drive) {
  ReducedImuFilter filter({}, test_origin());
  const std::vector<NavState> states =
      states_after_odometry(filter, as_available(drive.imu, drive.odometry, drive.start));
  EXPECT_EQ(states.size(), drive.odometry.size());
  for (int r = 0; r < (int)reason_count; ++r)
    if (filter.status().refused[(size_t)r])
      printf("   %s: %llu\n", to_string((Reason)r).data(),
             (unsigned long long)filter.status().refused[(size_t)r]);
  printf("   recoveries %llu\n", (unsigned long long)filter.status().recoveries);

  // Odometry alone starts with the same position and azimuth, and with the true pitch and roll.
  Attitude first = attitude_from_rotation(drive.truth.front().rotation());
  first.azimuth = std::atan2(drive.start.velocity_enu.x(), drive.start.velocity_enu.y());
  Eigen::Isometry3d pose =
      Eigen::Translation3d(LocalFrame(test_origin()).to_enu(drive.start.position)) *
      Eigen::Quaterniond(rotation_enu_body(first));
  Trajectory fused, odometry, truth(drive.truth.begin() + 1, drive.truth.end());
  for (const RelativeMotion& m : drive.odometry) odometry.push_back(pose = pose * m.T_from_to());
  for (const NavState& nav : states) fused.push_back(pose_of(nav));

  Comparison c;
  c.length = 0.0;
  for (std::size_t i = 1; i < truth.size(); ++i) {
    c.length += (truth[i].translation() - truth[i - 1].translation()).norm();
  }
  c.end_fused = horizontal_end_error(fused, truth);
  c.end_odometry = horizontal_end_error(odometry, truth);
  c.fused = segment_error(fused, truth, 100.0);
  c.odometry = segment_error(odometry, truth, 100.0);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double a = attitude_from_rotation(truth[i].rotation()).azimuth;
    c.heading_fused +=
        std::pow(wrap_angle(attitude_from_rotation(fused[i].rotation()).azimuth - a), 2);
    c.heading_odometry +=
        std::pow(wrap_angle(attitude_from_rotation(odometry[i].rotation()).azimuth - a), 2);
  }
  c.heading_fused = degrees(std::sqrt(c.heading_fused / (double)truth.size()));
  c.heading_odometry = degrees(std::sqrt(c.heading_odometry / (double)truth.size()));
  c.last = states.back();
  std::printf(
      "%-22s %5.0f m | end %6.2f fused %6.2f odometry m | 100 m %5.2f %5.2f %% | %.4f %.4f deg/m | "
      "az rms %.2f %.2f deg | sigma E %.1f N %.1f A %.2f deg up err %.1f/%.1f\n",
      drive.name.c_str(), c.length, c.end_fused, c.end_odometry, c.fused.translation,
      c.odometry.translation, c.fused.rotation, c.odometry.rotation, c.heading_fused,
      c.heading_odometry, std::sqrt(c.last.covariance(0, 0)), std::sqrt(c.last.covariance(1, 1)),
      degrees(std::sqrt(c.last.covariance(6, 6))),
      fused.back().translation().z() - truth.back().translation().z(),
      odometry.back().translation().z() - truth.back().translation().z());
  return c;
}

TEST(RealDrive, Explore) {
  MAPLOOP_REQUIRE_REAL_DATA();
  for (const char* name :
       {"2011_09_26_drive_0001", "2011_09_26_drive_0036", "2011_09_26_drive_0051",
        "2011_09_26_drive_0009", "2011_09_26_drive_0027", "2011_09_26_drive_0035",
        "2011_09_30_drive_0020", "2011_10_03_drive_0042"}) {
    const RecordedDrive d = load_track_drive(real_data(), name, {0.5, radians(0.1)});
    // noise per frame
    double n = 0, s2 = 0, sm = 0;
    Eigen::Vector3d r2 = Eigen::Vector3d::Zero(), rm = r2;
    for (size_t i = 0; i < d.odometry.size(); ++i) {
      auto T = d.truth[i].inverse() * d.truth[i + 1];
      auto& m = d.odometry[i];
      double dt = to_seconds(m.stamp - m.from);
      double es = (m.translation.x() - T.translation().x()) / dt;
      Eigen::AngleAxisd e(
          Eigen::Matrix3d(m.rotation.toRotationMatrix() * T.rotation().transpose()));
      Eigen::Vector3d v = degrees(1) * e.angle() * e.axis();
      s2 += es * es;
      sm += es;
      r2 += v.cwiseAbs2();
      rm += v;
      n++;
    }
    printf(
        "noise %s: speed rms %.3f mean %.3f; rot rms (r,p,y) %.3f %.3f %.3f mean %.3f %.3f %.3f\n",
        name, sqrt(s2 / n), sm / n, sqrt(r2[0] / n), sqrt(r2[1] / n), sqrt(r2[2] / n), rm[0] / n,
        rm[1] / n, rm[2] / n);
    {
      double tx = 0, ty = 0, tz = 0, vx = 0, vy = 0, vz = 0;
      for (size_t i = 0; i < d.odometry.size(); ++i) {
        auto T = d.truth[i].inverse() * d.truth[i + 1];
        auto& m = d.odometry[i];
        Eigen::AngleAxisd h(T.rotation());
        if (h.angle() > 0.01) continue;
        tx += T.translation().x();
        ty += T.translation().y();
        tz += T.translation().z();
        vx += m.translation.x();
        vy += m.translation.y();
        vz += m.translation.z();
      }
      printf(
          "  travel direction in body (deg): truth left %.2f up %.2f; odometry left %.2f up %.2f; "
          "truth first pitch %.2f\n",
          degrees(ty / tx), degrees(tz / tx), degrees(vy / vx), degrees(vz / vx),
          degrees(attitude_from_rotation(d.truth[0].rotation()).pitch));
    }
    compare(d);
  }
  for (const char* name : {"seq"}) {
    const RecordedDrive d = load_sequence_00(real_data(), {0.5, radians(0.15)});
    double n = 0, s2 = 0, sm = 0;
    Eigen::Vector3d r2 = Eigen::Vector3d::Zero(), rm = r2;
    for (size_t i = 0; i < d.odometry.size(); ++i) {
      auto T = d.truth[i].inverse() * d.truth[i + 1];
      auto& m = d.odometry[i];
      double dt = to_seconds(m.stamp - m.from);
      double es = (m.translation.x() - T.translation().x()) / dt;
      Eigen::AngleAxisd e(
          Eigen::Matrix3d(m.rotation.toRotationMatrix() * T.rotation().transpose()));
      Eigen::Vector3d v = degrees(1) * e.angle() * e.axis();
      s2 += es * es;
      sm += es;
      r2 += v.cwiseAbs2();
      rm += v;
      n++;
    }
    printf(
        "noise %s: speed rms %.3f mean %.3f; rot rms (r,p,y) %.3f %.3f %.3f mean %.3f %.3f %.3f\n",
        name, sqrt(s2 / n), sm / n, sqrt(r2[0] / n), sqrt(r2[1] / n), sqrt(r2[2] / n), rm[0] / n,
        rm[1] / n, rm[2] / n);
    compare(d);
    {
      double tx = 0, ty = 0, tz = 0, vx = 0, vy = 0, vz = 0;
      for (size_t i = 0; i < d.odometry.size(); ++i) {
        auto T = d.truth[i].inverse() * d.truth[i + 1];
        auto& m = d.odometry[i];
        Eigen::AngleAxisd h(T.rotation());
        if (h.angle() > 0.01) continue;
        tx += T.translation().x();
        ty += T.translation().y();
        tz += T.translation().z();
        vx += m.translation.x();
        vy += m.translation.y();
        vz += m.translation.z();
      }
      printf(
          "  travel direction in body (deg): truth left %.2f up %.2f; odometry left %.2f up %.2f; "
          "truth first pitch %.2f\n",
          degrees(ty / tx), degrees(tz / tx), degrees(vy / vx), degrees(vz / vx),
          degrees(attitude_from_rotation(d.truth[0].rotation()).pitch));
    }
  }
}

}  // namespace
}  // namespace maploop::fusion
