// This file replays a drive that is a folder of images, scans and rows as a vehicle's sensors.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "msgs/calibration.h"
#include "msgs/image.h"
#include "msgs/lidar_scan.h"
#include "sensors/camera/stereo_rig.h"
#include "sensors/folder/table_recording.h"
#include "sensors/imu/mount_alignment.h"
#include "sensors/replay/oxts_recording.h"
#include "sensors/replay/stereo_source.h"
#include "sensors/replay/velodyne_source.h"
#include "sensors/source.h"

namespace maploop::sensors {

struct KittiDriveParameters {
  double imu_delay = 0.060;       // s, by which KITTI's OXTS rates are older than their row's stamp
  double camera_readout = 0.005;  // s
  double max_pair_skew = 0.020;   // s
  double max_turn = 0.250;        // s
};

struct ImagePair {
  ImageFolder left, right;
};

// Says what a folder has, whatever its layout. Every part may be missing, but one of images, scans
// and OXTS rows is there.
struct DriveParts {
  std::filesystem::path folder;  // names the drive in errors
  VehicleCalibration calibration;
  std::optional<ImagePair> images;
  std::optional<StereoRig> raw_cameras;  // the images are rectified with it
  std::optional<VelodyneFolder> scans;
  std::filesystem::path clouds = {};  // in place of them, a folder of clouds; empty: none
  std::shared_ptr<const OxtsRows> oxts = {};
  std::shared_ptr<const TableRecording> tables = {};  // nullptr: there are none
  MountParameters mount = {};                         // of the tables' inertial unit
  std::vector<std::string> notes = {};                // sentences for the user: what was assumed
};

// The parts hold stamps and rows; each source reads its images or scans one at a time. Sources may
// outlive the drive, and each may run on its own thread.
class FolderDrive : public OxtsRecording {
 public:
  // Throws std::runtime_error that names the folder if it has nothing to replay, and
  // std::invalid_argument for a parameter that is negative or not finite.
  FolderDrive(DriveParts parts, const KittiDriveParameters& parameters);

  const VehicleCalibration& calibration() const { return parts_.calibration; }
  // Replaces the files' own, with which it must share the size of the images.
  void set_calibration(const VehicleCalibration& calibration) { parts_.calibration = calibration; }
  const std::filesystem::path& folder() const { return parts_.folder; }  // absolute
  const std::vector<std::string>& notes() const { return parts_.notes; }

  // These cover all left images, whether or not each can be read; if there are none, all scans or
  // rows. first_stamp() and last_stamp() skip what does not have a stamp.
  std::size_t frame_count() const { return stamps_.size(); }
  const std::vector<Time>& image_stamps() const { return stamps_; }
  Time first_stamp() const;
  Time last_stamp() const;

  bool has_images() const { return parts_.images.has_value(); }
  bool has_velodyne() const { return parts_.scans || !parts_.clouds.empty(); }
  const TableRecording* tables() const { return parts_.tables.get(); }
  const MountParameters& mount() const { return parts_.mount; }

  // Each call returns a new source from the start of the drive; it throws std::runtime_error if the
  // drive lacks its folder. Pixels and points that are available up to `passed` are not read and
  // must not be used: this is for callers that skip them.
  std::unique_ptr<Source<StereoPair>> camera(Time passed = Time::min()) const;
  std::unique_ptr<Source<LidarScan>> velodyne(Time passed = Time::min()) const;

 private:
  void take_stamps();

  DriveParts parts_;
  KittiDriveParameters parameters_;
  std::vector<Time> stamps_;
  Verdicts verdicts_;
};

}  // namespace maploop::sensors
