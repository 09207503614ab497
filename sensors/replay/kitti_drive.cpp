#include "sensors/replay/kitti_drive.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "msgs/input_limits.h"
#include "sensors/folder/stamps.h"
#include "sensors/number.h"
#include "sensors/replay/kitti_calibration.h"

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
  const bool any_sensor = is_folder(folder / "velodyne_points") || is_folder(folder / "oxts");
  const bool any_camera = is_folder(folder / "image_00") || is_folder(folder / "image_01");
  for (const char* camera : {"image_00", "image_01"}) {
    if (!is_folder(folder / camera) && (any_camera || !any_sensor)) {
      fail(std::string("it has no folder ") + camera +
           "; name the drive itself, synced and rectified, such as "
           "2011_09_26/2011_09_26_drive_0013_sync");
    }
  }
  return folder;
}

// Reads the stamps of a drive; or makes them where the drive has no file of stamps at all.
class DriveStamps {
 public:
  explicit DriveStamps(std::vector<std::filesystem::path> folders) {
    made_ = std::ranges::none_of(folders, [](const auto& folder) {
      std::error_code ignored;
      return std::filesystem::exists(folder / "timestamps.txt", ignored) ||
             std::filesystem::exists(folder / "timestamps_start.txt", ignored) ||
             std::filesystem::exists(folder / "timestamps_end.txt", ignored);
    });
  }

  bool made() const { return made_; }

  // Returns those of a file; frame i of a drive without stamps is 0.1 s after frame i - 1.
  Timestamps of(const std::filesystem::path& folder, const char* name, Duration offset = {}) const {
    if (!made_) return read_timestamps(folder / name);
    constexpr Duration period = std::chrono::milliseconds(100);
    const Time start = parse_time("2000-01-01 00:00:00");
    Timestamps stamps{folder / name, {}, {}};
    const std::size_t frames = count(folder / "data");
    for (std::size_t i = 0; i < frames; ++i)
      stamps.stamps.push_back(start + offset + static_cast<std::int64_t>(i) * period);
    stamps.verdicts.resize(frames);
    return stamps;
  }

 private:
  // Returns the number behind the last numbered file.
  static std::size_t count(const std::filesystem::path& data) {
    std::size_t frames = 0;
    for (const std::string& name : files_of_kind(data, {".png", ".bin", ".scan", ".txt"})) {
      const auto number = parse_number<std::size_t>(std::filesystem::path(name).stem().string());
      if (number && *number < input_limits::frames) frames = std::max(frames, *number + 1);
    }
    return frames;
  }

  bool made_ = false;
};

// Returns the mounting of a drive without images, whose files may be missing.
VehicleCalibration mounting_of(const std::filesystem::path& day, std::vector<std::string>& notes) {
  std::error_code ignored;
  if (std::filesystem::exists(day / "calib_imu_to_velo.txt", ignored))
    return read_kitti_mounting(day);
  notes.emplace_back(
      "There is no calib_imu_to_velo.txt beside the drive: the scanner is taken to "
      "stand at the body's origin.");
  return {};
}

DriveParts kitti_parts(const std::filesystem::path& given, std::optional<StereoRig> raw_cameras) {
  DriveParts parts;
  parts.folder = drive_folder(given, raw_cameras.has_value());
  parts.raw_cameras = std::move(raw_cameras);
  const std::filesystem::path named = normal(given);
  const auto left = parts.folder / "image_00", right = parts.folder / "image_01";
  const auto velodyne = parts.folder / "velodyne_points";
  const auto oxts = (is_unsynced(named) ? named : parts.folder) / "oxts";
  const std::filesystem::path day = parts.folder.parent_path();
  if (!is_folder(left)) {
    parts.raw_cameras.reset();
    parts.calibration = mounting_of(day, parts.notes);
  } else {
    parts.calibration = parts.raw_cameras
                            ? read_kitti_calibration(day, *parts.raw_cameras, is_folder(velodyne))
                            : read_kitti_calibration(day);
  }
  const DriveStamps stamps({left, right, velodyne, oxts});
  if (stamps.made())
    parts.notes.emplace_back("No file has stamps: frames are taken to be 0.1 s apart.");
  if (is_folder(left)) {
    const char* name = "timestamps.txt";
    parts.images =
        ImagePair{{left / "data", stamps.of(left, name)}, {right / "data", stamps.of(right, name)}};
  }
  if (is_folder(velodyne)) {
    constexpr Duration half_turn = std::chrono::milliseconds(50);
    parts.scans =
        VelodyneFolder{velodyne / "data", stamps.of(velodyne, "timestamps_start.txt", -half_turn),
                       stamps.of(velodyne, "timestamps.txt"),
                       stamps.of(velodyne, "timestamps_end.txt", half_turn)};
  }
  if (is_folder(oxts)) {
    parts.oxts =
        std::make_shared<const OxtsRows>(read_oxts(oxts, stamps.of(oxts, "timestamps.txt")));
  }
  return parts;
}

}  // namespace

KittiDrive::KittiDrive(const std::filesystem::path& folder, const KittiDriveParameters& parameters,
                       std::optional<StereoRig> raw_cameras)
    : FolderDrive(kitti_parts(folder, std::move(raw_cameras)), parameters) {}

std::filesystem::path kitti_image_folder(const std::filesystem::path& drive) {
  std::filesystem::path folder = normal(drive);
  if (!is_unsynced(folder)) return folder;
  std::filesystem::path synced = synced_beside(folder);
  return is_folder(synced) ? synced : folder;
}

}  // namespace maploop::sensors
