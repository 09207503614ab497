// The motion estimate on another front end's tracks of other drives: 60 to 100 features a pair.
#include <gtest/gtest.h>

#include "estimators/stereo/motion_estimator.h"
#include "msgs/frames.h"
#include "tests/estimators/stereo/recorded_tracks.h"
#include "tests/support/real_data.h"

namespace maploop::stereo {
namespace {

using maploop::testing::kitti_error;
using maploop::testing::RecordedTracks;
using maploop::testing::Trajectory;

// These tracks are few: the thresholds are what the geometry needs, not what the camera should
// show.
StereoParameters for_sparse_tracks() {
  StereoParameters parameters;
  parameters.min_tracks = 6;
  parameters.min_inliers = 6;
  parameters.min_disparity = 0.5;
  parameters.max_row_error = 1.5;
  return parameters;
}

// A pair that is refused repeats the last motion.
Trajectory follow(const RecordedTracks& recorded, int* refused) {
  const StereoParameters parameters = for_sparse_tracks();
  DisparityOffset offset(parameters);
  Trajectory estimate{Eigen::Isometry3d::Identity()};
  Eigen::Isometry3d last = Eigen::Isometry3d::Identity();
  for (std::size_t k = 0; k < recorded.pairs.size(); ++k) {
    offset.predict(recorded.seconds[k + 1] - recorded.seconds[k]);
    const CameraMotion motion =
        estimate_motion(recorded.calibration, parameters, recorded.pairs[k], k, offset,
                        k > 0 ? std::optional(last) : std::nullopt);
    if (motion.status == OdometryStatus::ok) {
      last = motion.T_previous_current;
      offset.update(motion.offset, motion.offset_sigma, static_cast<int>(motion.inliers.size()));
    } else {
      ++*refused;
    }
    estimate.push_back(estimate.back() * last);
  }
  return estimate;
}

struct Case {
  const char* drive;
  double translation;  // bound on the mean error of 50 m segments, a little above what is reached
};

void PrintTo(const Case& c, std::ostream* stream) {
  *stream << c.drive;
}

class RecordedTracksTest : public ::testing::TestWithParam<Case> {};

TEST_P(RecordedTracksTest, EndsNearerToTheReferenceThanAPlainTwoFrameOdometry) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const RecordedTracks recorded = maploop::testing::read_recorded_tracks(
      maploop::testing::real_data() / "kitti_odometry/tracks", GetParam().drive);
  int refused = 0;
  const auto error = kitti_error(follow(recorded, &refused), recorded.truth, 50.0);
  const auto baseline = kitti_error(recorded.baseline, recorded.truth, 50.0);
  EXPECT_EQ(refused, 0);
  EXPECT_LT(error.translation, GetParam().translation);
  EXPECT_LT(error.end_point, baseline.end_point);
  EXPECT_LT(error.rotation, baseline.rotation);
}

INSTANTIATE_TEST_SUITE_P(Drives, RecordedTracksTest,
                         ::testing::Values(Case{"2011_09_26_drive_0001", 0.016},
                                           Case{"2011_09_26_drive_0036", 0.023},
                                           Case{"2011_09_26_drive_0051", 0.022}),
                         [](const auto& param) { return std::string(param.param.drive); });

}  // namespace
}  // namespace maploop::stereo
