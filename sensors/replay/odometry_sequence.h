// A sequence of KITTI's odometry benchmark, from tables in place of images and row files.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "msgs/calibration.h"
#include "msgs/gnss.h"
#include "msgs/imu.h"
#include "msgs/reference.h"
#include "msgs/wheel_speed.h"
#include "sensors/replay/gnss_aid.h"
#include "sensors/replay/kitti_drive.h"
#include "sensors/replay/oxts.h"
#include "sensors/replay/wheel_odometer.h"
#include "sensors/source.h"

namespace maploop::sensors {

// Reads, each plain or .gz:
//   oxts/NN.csv        t and the 30 columns of OXTS, one row a frame
//   oxts/NN.gaps.csv   first_row, last_row of the stretches that the recording filled by straight
//                      lines: what lies inside is left out, and reported
//   poses/NN.times.txt when each image was taken, on the clock of oxts/NN.csv
//   tracks/<drive>.csv stereo tracks in place of images, if there are any
//   labels/NN.csv      links really driven, if there are any: not read, but found
//   imu100/<drive>.csv inertial samples at 100 Hz in place of the rows' own, if there are any
// Stamps are the raw drive's own (KITTI's clock, local time read as UTC).
class OdometrySequence {
 public:
  // Is this the name of a sequence: oxts/NN.csv[.gz], or FOLDER/NN where FOLDER has oxts/NN.csv?
  static bool is_named(const std::filesystem::path& path);

  // Throws std::runtime_error naming the file and what is wrong with it.
  OdometrySequence(const std::filesystem::path& path, const KittiDriveParameters& parameters);

  // Axes alone, with the benchmark's focal length.
  const VehicleCalibration& calibration() const { return calibration_; }

  std::size_t frame_count() const { return image_stamps_.size(); }
  Time first_stamp() const { return image_stamps_.front(); }
  Time last_stamp() const { return image_stamps_.back(); }
  const std::vector<Time>& image_stamps() const { return image_stamps_; }

  // Of stereo tracks, which have a calibration of their own.
  const std::optional<std::filesystem::path>& tracks_file() const { return tracks_; }

  // Of the links really driven, frame by frame.
  const std::optional<std::filesystem::path>& labels_file() const { return labels_; }

  // New sources, each from the start of the sequence.
  std::unique_ptr<Source<ImuSample>> imu() const;
  std::unique_ptr<Source<GnssFix>> gnss(const GnssAidParameters& parameters) const;
  std::unique_ptr<Source<WheelSpeed>> wheel(const WheelOdometerParameters& parameters) const;
  std::unique_ptr<Source<ReferencePose>> reference() const;

 private:
  Duration delay_;
  VehicleCalibration calibration_;
  std::vector<Time> image_stamps_;
  std::shared_ptr<const OxtsRows> rows_;
  std::shared_ptr<const OxtsRows> imu_rows_;
  std::optional<std::filesystem::path> tracks_, labels_;
};

}  // namespace maploop::sensors
