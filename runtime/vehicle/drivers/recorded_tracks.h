// Reads stereo feature tracks from a file, in place of images.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "estimators/stereo/parameters.h"
#include "estimators/stereo/tracks.h"
#include "msgs/calibration.h"
#include "msgs/time.h"

namespace maploop::vehicle {

struct RecordedTracks {
  struct Seen {
    std::int64_t id = 0;
    stereo::StereoObservation at;
  };

  StereoCalibration calibration;
  std::size_t first_good_frame = 0;
  std::vector<Time> stamps;               // one for each frame; frame 0 is at 0 s
  std::vector<std::vector<Seen>> frames;  // features of each frame, ordered by id

  // Adds the tracks that a front end followed from one frame to a later one. Frames in between stay
  // empty.
  void add(std::size_t previous, std::size_t current, std::span<const stereo::StereoTrack> tracks);

  // Returns the tracks seen in both frames.
  std::vector<stereo::StereoTrack> between(std::size_t previous, std::size_t current) const;
};

// `file` is <drive>.csv or <drive>.csv.gz: a heading, then one line for each feature in a frame:
// frame, track, uL, vL, uR, vR (rectified px). Beside it is <drive>.meta.json with fx, fy, cu, cv
// (px), baseline_m, timestamps (s), first_good_frame, suspect_tracks (which are left out) and, if
// known, T_imu_cam. Throws std::runtime_error naming file and line, or key, of what cannot be read.
RecordedTracks read_recorded_tracks(const std::filesystem::path& file);

// Returns <drive>.meta.json for <drive>.csv[.gz]. Throws std::runtime_error for another name.
std::filesystem::path meta_beside(std::filesystem::path file);

// Adapts `parameters` to files with 60 to 100 features a frame: the thresholds are what the
// geometry needs, not what a camera should deliver, and the noise is the one that is published with
// such tracks (inliers within 0.28 to 0.46 px rms).
stereo::StereoParameters for_recorded_tracks(stereo::StereoParameters parameters = {});

}  // namespace maploop::vehicle
