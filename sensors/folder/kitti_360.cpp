#include "sensors/folder/kitti_360.h"

#include <array>
#include <set>
#include <stdexcept>
#include <system_error>

#include "sensors/replay/kitti_calibration.h"

namespace maploop::sensors {
namespace {

namespace fs = std::filesystem;

constexpr auto parts_of_set =
    std::to_array<const char*>({"data_2d_raw", "data_3d_raw", "data_poses"});

bool has_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

// Returns the scans of a drive. Only the stamps at which they faced forward are recorded.
VelodyneFolder scans_of(const fs::path& folder) {
  constexpr Duration half_turn = std::chrono::milliseconds(50);
  VelodyneFolder scans;
  scans.data = folder / "data";
  scans.start = scans.middle = scans.end = read_timestamps(folder / "timestamps.txt");
  for (Time& stamp : scans.start.stamps) stamp -= half_turn;
  for (Time& stamp : scans.end.stamps) stamp += half_turn;
  return scans;
}

ImageFolder images_of(const fs::path& folder) {
  return {folder / "data_rect", read_timestamps(folder / "timestamps.txt"), {}, true, {}};
}

}  // namespace

std::optional<Kitti360Name> find_kitti_360(const fs::path& path) {
  fs::path folder = fs::absolute(path).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();
  for (const char* part : parts_of_set)
    if (folder.parent_path().filename() == part && has_folder(folder))
      return Kitti360Name{folder.parent_path().parent_path(), folder.filename().string()};
  std::set<std::string> drives;
  bool any = false;
  for (const char* part : parts_of_set) {
    any = any || has_folder(folder / part);
    std::error_code error;
    for (fs::directory_iterator entry(folder / part, error), end; !error && entry != end;
         entry.increment(error))
      if (has_folder(entry->path())) drives.insert(entry->path().filename().string());
  }
  if (!any) return std::nullopt;
  if (drives.size() == 1) return Kitti360Name{folder, *drives.begin()};
  std::string names;
  for (const std::string& drive : drives) names += (names.empty() ? "" : ", ") + drive;
  throw std::runtime_error("'" + path.string() + "' has " + std::to_string(drives.size()) +
                           " drives of KITTI-360 (" + names +
                           "): name the folder of one, such as data_3d_raw/NAME in it");
}

VehicleCalibration read_kitti_360_calibration(const fs::path& folder) {
  const std::string perspective_text = read_calibration_text(folder / "perspective.txt");
  const std::string pose_text = read_calibration_text(folder / "calib_cam_to_pose.txt");
  // This file has numbers without a key.
  const std::string velo_text =
      "cam_to_velo: " + read_calibration_text(folder / "calib_cam_to_velo.txt");
  const KeyedText perspective(perspective_text, folder / "perspective.txt");
  const KeyedText pose(pose_text, folder / "calib_cam_to_pose.txt");
  const KeyedText velo(velo_text, folder / "calib_cam_to_velo.txt");

  Eigen::Isometry3d T_body_imu = Eigen::Isometry3d::Identity();
  T_body_imu.linear() = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  const Eigen::Isometry3d T_body_raw = T_body_imu * pose.rigid("image_00");
  VehicleCalibration calibration;
  calibration.stereo = parse_rectified_pair(perspective);
  calibration.stereo.T_body_cam =
      T_body_raw * Eigen::Isometry3d(perspective.rotation("R_rect_00")).inverse();
  calibration.T_body_velo = T_body_raw * velo.rigid("cam_to_velo").inverse();
  return calibration;
}

DriveParts open_kitti_360(const Kitti360Name& name) {
  DriveParts parts;
  parts.folder = name.root / "data_2d_raw" / name.drive;
  const fs::path left = parts.folder / "image_00", right = parts.folder / "image_01";
  const fs::path scans = name.root / "data_3d_raw" / name.drive / "velodyne_points";
  const fs::path oxts = name.root / "data_poses" / name.drive / "oxts";
  if (has_folder(left) != has_folder(right)) {
    throw std::runtime_error("the drive '" + parts.folder.string() +
                             "' has the images of one camera: image_00 and image_01 are needed, or "
                             "neither of them");
  }
  if (has_folder(left)) parts.images = ImagePair{images_of(left), images_of(right)};
  if (has_folder(scans)) {
    parts.scans = scans_of(scans);
    parts.notes.emplace_back(
        "The scans are taken to begin 50 ms before their stamps and to end 50 ms after them.");
  }
  if (has_folder(oxts)) parts.oxts = std::make_shared<const OxtsRows>(read_oxts(oxts));
  if (parts.images || parts.scans)
    parts.calibration = read_kitti_360_calibration(name.root / "calibration");
  return parts;
}

}  // namespace maploop::sensors
