#include "sensors/folder/folder_drive.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "sensors/camera/rectifier.h"
#include "sensors/cloud/scan_folder.h"
#include "sensors/replay/parameter_table.h"

namespace maploop::sensors {

FolderDrive::FolderDrive(DriveParts parts, const KittiDriveParameters& parameters)
    : OxtsRecording(parts.folder.string(), from_seconds(parameters.imu_delay)),
      parts_(std::move(parts)),
      parameters_(parameters) {
  validate_parameters(parameters_);
  if (!parts_.images && !has_velodyne() && !parts_.oxts) {
    throw std::runtime_error(
        "the folder '" + parts_.folder.string() +
        "' has neither images of a pair of cameras nor scans nor oxts rows, of "
        "which a drive needs one (sensors/FORMATS.md)");
  }
  set_rows(parts_.oxts, parts_.oxts);
  take_stamps();
}

void FolderDrive::take_stamps() {
  if (parts_.images || parts_.scans) {
    const Timestamps& t = parts_.images ? parts_.images->left.timestamps : parts_.scans->middle;
    stamps_ = t.stamps;
    verdicts_ = t.verdicts;
  } else if (!parts_.clouds.empty()) {
    stamps_ = ScanFolder(parts_.clouds).stamps();
    verdicts_.resize(stamps_.size());
  } else {
    stamps_ = parts_.oxts->stamps;
    verdicts_ = parts_.oxts->verdicts;
  }
}

Time FolderDrive::first_stamp() const {
  const auto sound = std::ranges::find_if(verdicts_, [](const auto& v) { return !v; });
  return sound == verdicts_.end() ? Time{}
                                  : stamps_[static_cast<std::size_t>(sound - verdicts_.begin())];
}

Time FolderDrive::last_stamp() const {
  for (std::size_t i = frame_count(); i-- > 0;)
    if (!verdicts_[i]) return stamps_[i];
  return Time{};
}

std::unique_ptr<Source<StereoPair>> FolderDrive::camera(Time passed) const {
  if (!parts_.images)
    throw std::runtime_error("drive '" + folder().string() +
                             "' has no images of a pair of cameras");
  const Duration readout = from_seconds(parameters_.camera_readout);
  const Duration max_skew = from_seconds(parameters_.max_pair_skew);
  const auto& [left, right] = *parts_.images;
  if (!parts_.raw_cameras) {
    const StereoCalibration& stereo = calibration().stereo;
    return make_stereo_source(left, right, stereo.width, stereo.height, readout, max_skew, passed);
  }
  const StereoRig& rig = *parts_.raw_cameras;
  return make_rectified_source(
      make_stereo_source(left, right, rig.width, rig.height, readout, max_skew, passed), rig,
      passed);
}

std::unique_ptr<Source<LidarScan>> FolderDrive::velodyne(Time passed) const {
  const Duration max_turn = from_seconds(parameters_.max_turn);
  if (!parts_.clouds.empty()) return make_scan_source(parts_.clouds, max_turn, passed);
  if (!parts_.scans)
    throw std::runtime_error("drive '" + folder().string() + "' has no folder velodyne_points");
  return make_velodyne_source(*parts_.scans, max_turn, passed);
}

}  // namespace maploop::sensors
