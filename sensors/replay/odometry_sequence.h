// This file replays a drive given as a table of OXTS rows, such as a sequence of KITTI's odometry
// benchmark.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "msgs/calibration.h"
#include "sensors/replay/kitti_drive.h"
#include "sensors/replay/oxts_recording.h"

namespace maploop::sensors {

// The files, each plain or .gz, are those that find_sequence() finds; sensors/FORMATS.md describes
// them. Stamps of KITTI's sequences are the raw drive's own (KITTI's clock, local time read as
// UTC).
class OdometrySequence : public OxtsRecording {
 public:
  // Returns whether the path names a sequence: a table of OXTS rows, or FOLDER/NAME where FOLDER
  // has oxts/NAME.csv.
  static bool is_named(const std::filesystem::path& path);

  // Throws std::runtime_error that names the file and states what is wrong with it.
  OdometrySequence(const std::filesystem::path& path, const KittiDriveParameters& parameters);

  // This contains only axes, the benchmark's focal length, and the properties of KITTI's car.
  const VehicleCalibration& calibration() const { return calibration_; }

  std::size_t frame_count() const { return image_stamps_.size(); }
  Time first_stamp() const { return image_stamps_.front(); }
  Time last_stamp() const { return image_stamps_.back(); }
  const std::vector<Time>& image_stamps() const { return image_stamps_; }

  // This file contains stereo tracks, which have a calibration of their own.
  const std::optional<std::filesystem::path>& tracks_file() const { return tracks_; }

  // This file contains the links really driven, frame by frame.
  const std::optional<std::filesystem::path>& labels_file() const { return labels_; }

 private:
  VehicleCalibration calibration_;
  std::vector<Time> image_stamps_;
  std::optional<std::filesystem::path> tracks_, labels_;
};

}  // namespace maploop::sensors
