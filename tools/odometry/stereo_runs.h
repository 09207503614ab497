// Odometries that run alone, one motion a frame.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "estimators/lidar/parameters.h"
#include "estimators/stereo/parameters.h"
#include "estimators/stereo/tracks.h"
#include "msgs/odometry.h"
#include "runtime/vehicle/recorded_tracks.h"
#include "sensors/replay/kitti_drive.h"

namespace maploop::odometry {

using vehicle::for_recorded_tracks;
using vehicle::read_recorded_tracks;
using vehicle::RecordedTracks;

// Frames of a drive, by their numbers; both ends belong to it.
struct FrameRange {
  std::size_t first = 0;
  std::size_t last = std::numeric_limits<std::size_t>::max();
};

// Who says what constant is missing in all disparities.
enum class Disparities : std::uint8_t {
  none,   // nobody: the rectification is taken as perfect
  own,    // the image pairs themselves (stereo/disparity_offset.h)
  lidar,  // they and LiDAR odometry (lidar/disparity_correction.h)
};
constexpr std::array<std::string_view, 3> names_of(Disparities) {
  return {"none", "own", "lidar"};
}

struct Step {
  std::size_t frame = 0;
  RelativeMotion motion;
  double milliseconds = 0.0;  // of processor time that the estimate took, reading not counted
  std::vector<std::pair<std::string, double>> stages;  // their share of it, ms, as they ended
  std::vector<stereo::StereoTrack> tracks;             // that it was made from
};

// The next step; nothing at the end.
using Run = std::function<std::optional<Step>()>;

// Visual odometry from a drive's images; with `depth`, given the length that LiDAR odometry from
// the drive's scans has so far (lidar/disparity_correction.h). `drive` must outlive the run.
Run stereo_run(const sensors::KittiDrive& drive, const stereo::StereoParameters& parameters,
               FrameRange frames, const std::optional<lidar::LidarParameters>& depth = {});

// The same from recorded tracks: frames before first_good_frame are passed over.
Run tracks_run(std::shared_ptr<const RecordedTracks> tracks,
               const stereo::StereoParameters& parameters, FrameRange frames);

}  // namespace maploop::odometry
