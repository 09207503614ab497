#include "msgs/local_frame.h"

#include <gtest/gtest.h>

#include "msgs/frames.h"

namespace maploop {
namespace {

const Geodetic karlsruhe{radians(49.013), radians(8.438), 114.0};

TEST(LocalFrame, TheOriginIsZero) {
  EXPECT_NEAR(LocalFrame(karlsruhe).to_enu(karlsruhe).norm(), 0.0, 1e-9);
}

// The radii of curvature of WGS84 are M = a (1 - e^2) / (1 - e^2 sin^2)^1.5, N = a / sqrt(1 - e^2
// sin^2).
TEST(LocalFrame, AnArcSecondHasTheLengthOfItsRadiusOfCurvature) {
  const double e2 = 0.00669437999014;
  const double s = std::sin(karlsruhe.latitude);
  const double w = 1.0 - e2 * s * s;
  const double M = 6378137.0 * (1.0 - e2) / std::pow(w, 1.5);
  const double N = 6378137.0 / std::sqrt(w);
  const double arc = radians(1.0 / 3600.0);
  const LocalFrame frame(karlsruhe);
  EXPECT_NEAR(frame.to_enu({karlsruhe.latitude + arc, karlsruhe.longitude, 114.0}).y(),
              (M + 114.0) * arc, 1e-3);
  EXPECT_NEAR(frame.to_enu({karlsruhe.latitude, karlsruhe.longitude + arc, 114.0}).x(),
              (N + 114.0) * std::cos(karlsruhe.latitude) * arc, 1e-3);
}

TEST(LocalFrame, PointsSurviveTheRoundTrip) {
  const LocalFrame frame(karlsruhe);
  const Eigen::Vector3d p(1234.5, -987.6, 12.3);
  EXPECT_NEAR((frame.to_enu(frame.to_geodetic(p)) - p).norm(), 0.0, 1e-7);
}

}  // namespace
}  // namespace maploop
