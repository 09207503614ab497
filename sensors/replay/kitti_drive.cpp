#include "sensors/replay/kitti_drive.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "sensors/camera/rectifier.h"
#include "sensors/replay/kitti_calibration.h"
#include "sensors/replay/parameter_table.h"

namespace maploop::sensors {
namespace {

bool is_folder(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_directory(path, ignored);
}

constexpr std::string_view unsynced = "_extract";

bool is_unsynced(const std::filesystem::path& folder) {
  return folder.filename().string().ends_with(unsynced);
}

std::filesystem::path synced_beside(const std::filesystem::path& folder) {
  const std::string name = folder.filename().string();
  return folder.parent_path() / (name.substr(0, name.size() - unsynced.size()) + "_sync");
}

std::filesystem::path normal(const std::filesystem::path& given) {
  const std::filesystem::path folder = std::filesystem::absolute(given).lexically_normal();
  return folder.has_filename() ? folder : folder.parent_path();
}

// Returns the folder of the images, absolute and without a trailing slash, so that its parent is
// the day's.
std::filesystem::path drive_folder(const std::filesystem::path& given, bool raw) {
  const auto fail = [&given](const std::string& reason) {
    throw std::runtime_error("no KITTI drive at '" + given.string() + "': " + reason);
  };
  if (given.empty() || !is_folder(given)) {
    fail(
        "it is not a folder; name a synced and rectified raw drive, such as "
        "2011_09_26/2011_09_26_drive_0013_sync");
  }
  std::filesystem::path folder = normal(given);
  if (!raw && is_unsynced(folder)) {
    const std::filesystem::path synced = synced_beside(folder);
    if (!is_folder(synced)) {
      fail("it is the unsynced form, whose images are not rectified; put " +
           synced.filename().string() +
           " beside it, or name the cameras' calibration in the configuration ([vehicle.camera] "
           "calibration)");
    }
    if (!is_folder(folder / "oxts")) fail("it has no folder oxts");
    folder = synced;
  }
  for (const char* camera : {"image_00", "image_01"}) {
    if (!is_folder(folder / camera)) {
      fail(std::string("it has no folder ") + camera +
           "; name the drive itself, synced and rectified, such as "
           "2011_09_26/2011_09_26_drive_0013_sync");
    }
  }
  return folder;
}

ImageFolder image_folder(const std::filesystem::path& folder) {
  return {folder / "data", read_timestamps(folder / "timestamps.txt")};
}

}  // namespace

KittiDrive::KittiDrive(const std::filesystem::path& folder, const KittiDriveParameters& parameters,
                       std::optional<StereoRig> raw_cameras)
    : OxtsRecording(folder.string(), from_seconds(parameters.imu_delay)),
      folder_(drive_folder(folder, raw_cameras.has_value())),
      parameters_(parameters),
      raw_cameras_(std::move(raw_cameras)) {
  validate_parameters(parameters_);
  const std::filesystem::path day = folder_.parent_path();
  calibration_ = raw_cameras_ ? read_kitti_calibration(day, *raw_cameras_,
                                                       is_folder(folder_ / "velodyne_points"))
                              : read_kitti_calibration(day);
  left_ = image_folder(folder_ / "image_00");
  right_ = image_folder(folder_ / "image_01");
  if (const auto velodyne = folder_ / "velodyne_points"; is_folder(velodyne)) {
    velodyne_ =
        VelodyneFolder{velodyne / "data", read_timestamps(velodyne / "timestamps_start.txt"),
                       read_timestamps(velodyne / "timestamps.txt"),
                       read_timestamps(velodyne / "timestamps_end.txt")};
  }
  const std::filesystem::path named = normal(folder);
  if (const auto oxts = (is_unsynced(named) ? named : folder_) / "oxts"; is_folder(oxts)) {
    const auto rows = std::make_shared<const OxtsRows>(read_oxts(oxts));
    set_rows(rows, rows);
  }
}

Time KittiDrive::first_stamp() const {
  const Timestamps& t = left_.timestamps;
  std::size_t i = 0;
  while (t.verdicts[i]) ++i;
  return t.stamps[i];
}

Time KittiDrive::last_stamp() const {
  const Timestamps& t = left_.timestamps;
  std::size_t i = t.size() - 1;
  while (t.verdicts[i]) --i;
  return t.stamps[i];
}

std::unique_ptr<Source<StereoPair>> KittiDrive::camera(Time passed) const {
  const Duration readout = from_seconds(parameters_.camera_readout);
  const Duration max_skew = from_seconds(parameters_.max_pair_skew);
  if (!raw_cameras_) {
    return make_stereo_source(left_, right_, calibration_.stereo.width, calibration_.stereo.height,
                              readout, max_skew, passed);
  }
  auto raw = make_stereo_source(left_, right_, raw_cameras_->width, raw_cameras_->height, readout,
                                max_skew, passed);
  return make_rectified_source(std::move(raw), *raw_cameras_, passed);
}

std::unique_ptr<Source<LidarScan>> KittiDrive::velodyne(Time passed) const {
  if (!velodyne_) {
    throw std::runtime_error("drive '" + folder_.string() + "' has no folder velodyne_points");
  }
  return make_velodyne_source(*velodyne_, from_seconds(parameters_.max_turn), passed);
}

}  // namespace maploop::sensors
