// Stereo feature tracks recorded in a file, in place of images.
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
  std::vector<Time> stamps;               // of each frame; frame 0 is at 0 s
  std::vector<std::vector<Seen>> frames;  // ordered by id

  // What a front end followed from one frame to a later one. Frames in between stay empty.
  void add(std::size_t previous, std::size_t current, std::span<const stereo::StereoTrack> tracks);

  // Tracks seen in both frames.
  std::vector<stereo::StereoTrack> between(std::size_t previous, std::size_t current) const;
};

// `file` is <drive>.csv or <drive>.csv.gz: a heading, then frame, track, uL, vL, uR, vR a line;
// beside it stands <drive>.meta.json with fx, fy, cu, cv, baseline_m, timestamps (s),
// first_good_frame, suspect_tracks (left out) and, if known, T_imu_cam. Throws std::runtime_error
// naming file and line, or key, where something cannot be read.
RecordedTracks read_recorded_tracks(const std::filesystem::path& file);

// <drive>.csv[.gz] -> <drive>.meta.json. Throws std::runtime_error where the name is another.
std::filesystem::path meta_beside(std::filesystem::path file);

// For files with 60 to 100 features a frame: thresholds are what the geometry needs, not what a
// camera should show; noise is what such tracks are published with (inliers within 0.28 to 0.46 px
// rms).
stereo::StereoParameters for_recorded_tracks(stereo::StereoParameters parameters = {});

}  // namespace maploop::vehicle
