// Odometries that run alone, one motion for each frame.
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
#include "runtime/vehicle/drivers/recorded_tracks.h"
#include "runtime/vehicle/drivers/recording.h"

namespace maploop::odometry {

using vehicle::for_recorded_tracks;
using vehicle::read_recorded_tracks;
using vehicle::RecordedTracks;

// A range of frame numbers; both ends are included.
struct FrameRange {
  std::size_t first = 0;
  std::size_t last = std::numeric_limits<std::size_t>::max();
};

// The source of the constant by which all disparities are corrected.
enum class Disparities : std::uint8_t {
  none,   // no correction: the rectification is assumed to be perfect
  own,    // the image pairs themselves (stereo/disparity_offset.h)
  lidar,  // the image pairs and LiDAR odometry (lidar/disparity_correction.h)
};
constexpr std::array<std::string_view, 3> names_of(Disparities) {
  return {"none", "own", "lidar"};
}

struct Step {
  std::size_t frame = 0;
  RelativeMotion motion;
  double milliseconds = 0.0;  // of processor time for the estimate, without reading
  std::vector<std::pair<std::string, double>> stages;  // ms of each stage, in order
  std::vector<stereo::StereoTrack> tracks;  // the tracks that the motion was estimated from
};

// Finds the scan during which each image pair was taken.
class FrameScans {
 public:
  // Throws std::runtime_error if there are no scans (nullptr).
  explicit FrameScans(std::unique_ptr<sensors::Source<LidarScan>> scans);

  // Returns the scan of this moment, or null if there is none. Moments must be requested in
  // ascending order. The scan is valid until the next call.
  const LidarScan* of(Time stamp);

 private:
  std::unique_ptr<sensors::Source<LidarScan>> scans_;
  LidarScan scan_;
  bool loaded_ = false;
  bool ended_ = false;
};

// Returns the processor time of this thread; other work on the machine does not count.
double processor_milliseconds();

// Returns the next step, or nothing at the end.
using Run = std::function<std::optional<Step>()>;

// Returns visual odometry from the images of a recording. With `depth`, the lengths of its motions
// are corrected with the LiDAR odometry of the scans so far (lidar/disparity_correction.h). Throws
// std::runtime_error if the recording has no images, or no scans for `depth`.
Run stereo_run(const vehicle::Recording& recording, const stereo::StereoParameters& parameters,
               FrameRange frames, const std::optional<lidar::LidarParameters>& depth = {});

// Returns the same from recorded tracks: frames before first_good_frame are skipped.
Run tracks_run(std::shared_ptr<const RecordedTracks> tracks,
               const stereo::StereoParameters& parameters, FrameRange frames);

}  // namespace maploop::odometry
