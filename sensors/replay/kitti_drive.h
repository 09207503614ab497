// This file replays a KITTI raw drive, or raw images in its layout, as a vehicle's sensors.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "msgs/calibration.h"
#include "msgs/image.h"
#include "msgs/lidar_scan.h"
#include "sensors/camera/stereo_rig.h"
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

// Reads `2011_09_26/2011_09_26_drive_0013_sync` with its own layout:
//   image_00, image_01   timestamps.txt, data/%010d.png   left and right rectified grey
//   velodyne_points      timestamps{,_start,_end}.txt, data/%010d.bin or .scan (packed_scan.h)
//   oxts                 timestamps.txt, data/%010d.txt
//   ../calib_cam_to_cam.txt, ../calib_velo_to_cam.txt, ../calib_imu_to_velo.txt
// If the unsynced form, `..._extract`, is named, its OXTS rows (100 Hz) replace the synced ones;
// images and scans come from the `..._sync` folder beside it, because the unsynced images are not
// rectified. Stamps are the files' own: Karlsruhe's local time read as UTC.
//
// The constructor reads the calibration, all stamps and the OXTS rows; each source reads its images
// or scans one at a time. Sources may outlive the drive, and each may run on its own thread. A
// drive may lack the whole folder velodyne_points or oxts.
//
// With the calibration of raw cameras, image_00 and image_01 contain raw images, which are
// rectified as they are read. calib_cam_to_cam.txt is then not needed, and the other texts only if
// the drive has velodyne_points, or if the rig's own pose is not known: a folder with only image_00
// and image_01 is a valid drive.
class KittiDrive : public OxtsRecording {
 public:
  // Throws std::runtime_error that names the folder or file and states what to do (no such drive,
  // no calibration beside it, a time stamp file missing or empty), and std::invalid_argument for a
  // parameter that is negative or not finite.
  explicit KittiDrive(const std::filesystem::path& folder,
                      const KittiDriveParameters& parameters = {},
                      std::optional<StereoRig> raw_cameras = {});

  const VehicleCalibration& calibration() const { return calibration_; }
  // Replaces the files' own, with which it must share the size of the images.
  void set_calibration(const VehicleCalibration& calibration) { calibration_ = calibration; }
  const std::filesystem::path& folder() const { return folder_; }  // of the images, absolute

  // These cover all left images, whether or not each can be read; first_stamp() and last_stamp()
  // skip lines that do not contain a stamp.
  std::size_t frame_count() const { return left_.timestamps.size(); }
  const std::vector<Time>& image_stamps() const { return left_.timestamps.stamps; }
  Time first_stamp() const;
  Time last_stamp() const;

  bool has_velodyne() const { return velodyne_.has_value(); }

  // Each call returns a new source from the start of the drive; it throws std::runtime_error if the
  // drive lacks its folder. Pixels and points that are available up to `passed` are not read and
  // must not be used: this is for callers that skip them.
  std::unique_ptr<Source<StereoPair>> camera(Time passed = Time::min()) const;
  std::unique_ptr<Source<LidarScan>> velodyne(Time passed = Time::min()) const;

 private:
  std::filesystem::path folder_;
  KittiDriveParameters parameters_;
  std::optional<StereoRig> raw_cameras_;
  VehicleCalibration calibration_;
  ImageFolder left_;
  ImageFolder right_;
  std::optional<VelodyneFolder> velodyne_;
};

}  // namespace maploop::sensors
