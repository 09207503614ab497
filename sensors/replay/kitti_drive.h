// A KITTI raw drive, or raw images in its layout, as a vehicle that can be replayed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "msgs/calibration.h"
#include "msgs/gnss.h"
#include "msgs/image.h"
#include "msgs/imu.h"
#include "msgs/lidar_scan.h"
#include "msgs/reference.h"
#include "sensors/camera/stereo_rig.h"
#include "sensors/replay/gnss_aid.h"
#include "sensors/replay/oxts.h"
#include "sensors/replay/stereo_source.h"
#include "sensors/replay/velodyne_source.h"
#include "sensors/replay/wheel_odometer.h"
#include "sensors/source.h"

namespace maploop::sensors {

struct KittiDriveParameters {
  // s; OXTS rates, velocities and accelerations belong to this long before their row's stamp
  // (measured on all odometry sequences: 53 to 67 ms).
  double imu_delay = 0.060;
  double camera_readout = 0.005;  // s from the later exposure of a pair to its delivery
  double max_pair_skew = 0.020;   // s between left and right; 3.5 ms is the most seen
  double max_turn = 0.250;        // s for a scan; the HDL-64E's slowest turn takes 0.2
};

// Reads `2011_09_26/2011_09_26_drive_0013_sync` with its own layout:
//   image_00, image_01   timestamps.txt, data/%010d.png   left and right rectified grey
//   velodyne_points      timestamps{,_start,_end}.txt, data/%010d.bin or .scan (packed_scan.h)
//   oxts                 timestamps.txt, data/%010d.txt
//   ../calib_cam_to_cam.txt, ../calib_velo_to_cam.txt, ../calib_imu_to_velo.txt
// Named `..._extract`, the unsynced form, its OXTS rows (100 Hz) take the place of the synced ones;
// images and scans are those of the `..._sync` folder beside it, for the unsynced images are not
// rectified.
// Stamps are the files' own: Karlsruhe's local time read as UTC.
//
// Opening it reads the calibration, all stamps and the OXTS rows; images and scans are read one at
// a time by their source. Sources may outlive the drive, and may each run on a thread of its own.
// A drive may lack velodyne_points or oxts as a whole folder.
//
// With the calibration of raw cameras, image_00 and image_01 hold raw images, which are rectified
// as they are read. calib_cam_to_cam.txt is then not needed, and the others only where the drive
// has velodyne_points, or where the calibration does not say where the cameras are mounted: a
// folder with nothing but image_00 and image_01 is a drive.
class KittiDrive {
 public:
  // Throws std::runtime_error that names the folder or file and says what to do: no such drive, no
  // calibration beside it, a time stamp file missing or empty; std::invalid_argument for a
  // parameter that is negative or not finite.
  explicit KittiDrive(const std::filesystem::path& folder,
                      const KittiDriveParameters& parameters = {},
                      std::optional<StereoRig> raw_cameras = {});

  const VehicleCalibration& calibration() const { return calibration_; }
  const std::filesystem::path& folder() const { return folder_; }  // of the images, absolute

  // Numbers and stamps of the left images, whether or not each can be read; lines that hold no
  // stamp are passed over by first and last.
  std::size_t frame_count() const { return left_.timestamps.size(); }
  const std::vector<Time>& image_stamps() const { return left_.timestamps.stamps; }
  Time first_stamp() const;
  Time last_stamp() const;

  bool has_velodyne() const { return velodyne_.has_value(); }
  bool has_oxts() const { return oxts_ != nullptr; }

  // New sources, each from the start of the drive. Those of a folder that the drive lacks throw
  // std::runtime_error. Pixels and points of what is available up to `passed` are not read, and not
  // to be used: for who only passes over them.
  std::unique_ptr<Source<StereoPair>> camera(Time passed = Time::min()) const;
  std::unique_ptr<Source<LidarScan>> velodyne(Time passed = Time::min()) const;
  std::unique_ptr<Source<ImuSample>> imu() const;
  std::unique_ptr<Source<GnssFix>> gnss(const GnssAidParameters& parameters = {}) const;
  std::unique_ptr<Source<WheelSpeed>> wheel(const WheelOdometerParameters& parameters = {}) const;
  std::unique_ptr<Source<ReferencePose>> reference() const;

 private:
  const std::shared_ptr<const OxtsRows>& oxts() const;

  std::filesystem::path folder_;
  KittiDriveParameters parameters_;
  std::optional<StereoRig> raw_cameras_;
  VehicleCalibration calibration_;
  ImageFolder left_;
  ImageFolder right_;
  std::optional<VelodyneFolder> velodyne_;
  std::shared_ptr<const OxtsRows> oxts_;
};

}  // namespace maploop::sensors
