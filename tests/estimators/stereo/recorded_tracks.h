// Stereo feature tracks of other drives, recorded by another front end.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "estimators/stereo/tracks.h"
#include "msgs/calibration.h"
#include "tests/estimators/stereo/kitti_error.h"

namespace maploop::testing {

struct RecordedTracks {
  StereoCalibration calibration;
  std::vector<double> seconds;                          // stamp of each frame, from the first
  std::vector<std::vector<stereo::StereoTrack>> pairs;  // [k]: from frame k to k + 1
  Trajectory truth;                                     // left camera, one a frame
  Trajectory baseline;  // a plain two-frame odometry on the same tracks
};

// `folder` holds <drive>.csv.gz, .meta.json, .truth.csv.gz and .vo_baseline.txt.gz. Frames before
// first_good_frame and the tracks named as suspect are left out. Throws std::runtime_error naming
// a file that cannot be read.
RecordedTracks read_recorded_tracks(const std::filesystem::path& folder, const std::string& drive);

}  // namespace maploop::testing
