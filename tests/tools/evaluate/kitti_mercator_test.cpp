#include "tools/evaluate/kitti_mercator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "msgs/frames.h"
#include "msgs/local_frame.h"

namespace maploop::evaluation {
namespace {

// The projection of KITTI's devkit (raw data development kit, latlonToMercator.m).
Eigen::Vector3d mercator(const Geodetic& origin, const Geodetic& at) {
  constexpr double radius = 6378137.0;
  const double scale = std::cos(origin.latitude);
  const auto north = [&](double latitude) {
    return scale * radius * std::log(std::tan(M_PI / 4.0 + latitude / 2.0));
  };
  return {scale * radius * (at.longitude - origin.longitude),
          north(at.latitude) - north(origin.latitude), at.height - origin.height};
}

TEST(KittiMercator, PosesComeBackInMetresWhicheverWayTheFirstCameraLooks) {
  const Geodetic origin{radians(49.03), radians(8.39), 110.0};
  const LocalFrame frame(origin);
  for (const double azimuth : {0.0, 0.7, 2.0, -2.5}) {
    Eigen::Matrix3d R_enu_cam;  // columns: right, down, ahead
    R_enu_cam << std::cos(azimuth), 0.0, std::sin(azimuth), -std::sin(azimuth), 0.0,
        std::cos(azimuth), 0.0, -1.0, 0.0;
    Trajectory published, truth;
    for (const Eigen::Vector3d& p :
         {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(400, 0, 2), Eigen::Vector3d(400, -300, 0)}) {
      truth.emplace_back(Eigen::Translation3d(R_enu_cam.transpose() * p));
      published.emplace_back(
          Eigen::Translation3d(R_enu_cam.transpose() * mercator(origin, frame.to_geodetic(p))));
    }
    const Trajectory metric = from_kitti_mercator(published, origin.latitude, azimuth);
    EXPECT_GT((published[1].translation() - truth[1].translation()).norm(), 0.5);
    for (std::size_t i = 0; i < truth.size(); ++i)  // over 400 m the Earth's curvature is 1 cm up
      EXPECT_LT((metric[i].translation() - truth[i].translation()).norm(), 0.04) << i;
  }
}

}  // namespace
}  // namespace maploop::evaluation
