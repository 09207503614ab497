// This file replays a KITTI raw drive, or raw images in its layout, as a vehicle's sensors.
#pragma once

#include <filesystem>
#include <optional>

#include "sensors/camera/stereo_rig.h"
#include "sensors/folder/folder_drive.h"

namespace maploop::sensors {

// Reads `2011_09_26/2011_09_26_drive_0013_sync` with its own layout:
//   image_00, image_01   timestamps.txt, data/%010d.png   left and right rectified grey
//   velodyne_points      timestamps{,_start,_end}.txt, data/%010d.bin or .scan (packed_scan.h)
//   oxts                 timestamps.txt, data/%010d.txt
//   ../calib_cam_to_cam.txt, ../calib_velo_to_cam.txt, ../calib_imu_to_velo.txt
// If the unsynced form, `..._extract`, is named, its OXTS rows (100 Hz) replace the synced ones;
// images and scans come from the `..._sync` folder beside it, because the unsynced images are not
// rectified. Stamps are the files' own: Karlsruhe's local time read as UTC.
//
// The constructor reads the calibration, all stamps and the OXTS rows. A drive may lack the whole
// folders of any of its sensors, but not of one camera only; without images, the calibration may be
// missing too, and the scanner then stands at the body's origin. If no file of stamps is there, 10
// Hz are assumed, and a note says so.
//
// With the calibration of raw cameras, image_00 and image_01 contain raw images, which are
// rectified as they are read. calib_cam_to_cam.txt is then not needed, and the other texts only if
// the drive has velodyne_points, or if the rig's own pose is not known: a folder with only image_00
// and image_01 is a valid drive.
class KittiDrive : public FolderDrive {
 public:
  // Throws std::runtime_error that names the folder or file and states what to do (no such drive,
  // no calibration beside it, a time stamp file missing or empty), and std::invalid_argument for a
  // parameter that is negative or not finite.
  explicit KittiDrive(const std::filesystem::path& folder,
                      const KittiDriveParameters& parameters = {},
                      std::optional<StereoRig> raw_cameras = {});
};

// Returns the folder that holds a drive's images and scans: the `..._sync` beside an `..._extract`
// if there is one, or else the drive's own folder.
std::filesystem::path kitti_image_folder(const std::filesystem::path& drive);

}  // namespace maploop::sensors
