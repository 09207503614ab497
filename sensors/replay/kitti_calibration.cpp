#include "sensors/replay/kitti_calibration.h"

#include <stdexcept>
#include <string>
#include <vector>

#include "sensors/replay/keyed_text.h"

namespace maploop::sensors {
namespace {

CameraModel raw_camera(const KeyedText& text, const std::string& number) {
  const std::vector<double> k = text.numbers("K_" + number, 9);
  const std::vector<double> d = text.numbers("D_" + number, 5);
  return {k[0], k[4], k[2], k[5], {d[0], d[1], d[2], d[3], d[4]}};
}

Eigen::Isometry3d body_velo(const KittiCalibrationText& text) {
  return KeyedText(text.imu_to_velo, text.imu_to_velo_file).transformation().inverse();
}

// Returns T_body_left of the raw left camera.
Eigen::Isometry3d body_left(const KittiCalibrationText& text) {
  const KeyedText velo_to_cam(text.velo_to_cam, text.velo_to_cam_file);
  return body_velo(text) * velo_to_cam.transformation().inverse();
}

// Recognizes KITTI's own files, which contain this line for every day of recording.
bool is_kitti_car(const KittiCalibrationText& text) {
  return text.imu_to_velo.find("calib_time: 25-May-2012") != std::string_view::npos;
}

// Holds the names of a day's three files and the texts that were read.
struct CalibrationFiles {
  explicit CalibrationFiles(const std::filesystem::path& folder) {
    text.cam_to_cam_file = folder / "calib_cam_to_cam.txt";
    text.velo_to_cam_file = folder / "calib_velo_to_cam.txt";
    text.imu_to_velo_file = folder / "calib_imu_to_velo.txt";
  }
  void read_cameras() { text.cam_to_cam = cameras = read_calibration_text(text.cam_to_cam_file); }
  void read_mounting() {
    text.velo_to_cam = camera_mounting = read_calibration_text(text.velo_to_cam_file);
    read_scanner();
  }
  void read_scanner() {
    text.imu_to_velo = scanner_mounting = read_calibration_text(text.imu_to_velo_file);
  }

  KittiCalibrationText text;
  std::string cameras, camera_mounting, scanner_mounting;
};

}  // namespace

StereoCalibration parse_rectified_pair(const KeyedText& text) {
  const std::vector<double> size = text.size("S_rect_00");
  const std::vector<double> left = text.numbers("P_rect_00", 12);
  const std::vector<double> right = text.numbers("P_rect_01", 12);
  if (text.numbers("S_rect_01", 2) != size) text.fail("S_rect_01", "differs from S_rect_00");
  if (left[3] != 0.0)
    text.fail("P_rect_00", "has an offset: it is not the projection of the left camera");
  for (const std::size_t i : {0U, 2U, 5U, 6U}) {  // fx, cx, fy, cy
    if (left[i] != right[i]) text.fail("P_rect_01", "has intrinsics that differ from P_rect_00");
  }
  if (left[0] < 1.0 || left[5] < 1.0 || left[0] > 1e5 || left[5] > 1e5) {
    text.fail("P_rect_00", "has a focal length outside 1 to 100000 pixels");
  }
  StereoCalibration calibration;
  calibration.width = static_cast<int>(size[0]);
  calibration.height = static_cast<int>(size[1]);
  calibration.fx = left[0];
  calibration.fy = left[5];
  calibration.cx = left[2];
  calibration.cy = left[6];
  calibration.baseline = -right[3] / right[0];
  if (!(calibration.baseline > 0.01 && calibration.baseline < 10.0)) {
    text.fail("P_rect_01", "gives a baseline of " + std::to_string(calibration.baseline) +
                               " m, outside 0.01 to 10 m");
  }
  return calibration;
}

VehicleCalibration parse_kitti_calibration(const KittiCalibrationText& text) {
  const KeyedText cameras(text.cam_to_cam, text.cam_to_cam_file);
  VehicleCalibration calibration;
  calibration.stereo = parse_rectified_pair(cameras);
  const Eigen::Isometry3d T_cam_cam0(cameras.rotation("R_rect_00"));
  calibration.T_body_velo = body_velo(text);
  calibration.stereo.T_body_cam = body_left(text) * T_cam_cam0.inverse();
  if (is_kitti_car(text)) describe_kitti_car(calibration);
  return calibration;
}

void describe_kitti_car(VehicleCalibration& calibration) {
  calibration.rear_axle_distance = -0.28;
  calibration.climb_offset = 0.0084;
  calibration.climb_offset_sigma = 0.0087;
  calibration.beam_elevation = 0.00357792;
}

void describe_kitti_car(const VehicleCalibration& calibration, VehicleDescription& description) {
  VehicleCalibration kitti;
  describe_kitti_car(kitti);
  if (calibration.rear_axle_distance == kitti.rear_axle_distance)
    description.car.rear_axle_distance_sigma = 0.1;
  if (calibration.beam_elevation != kitti.beam_elevation) return;
  description.car.rear_slip = 0.0085;
  description.car.rear_slip_sigma = 0.0015;
  description.car.side_of_road = RoadSide::right;
  description.lidar.model = "HDL-64E";
  description.lidar.beam_elevation_sigma = 0.0005;
  description.imu.time = {0.06, 0.005};
  SensorPosition& antenna = description.antenna.position;
  antenna.forward_sigma = antenna.left_sigma = antenna.up_sigma = 0.01;
}

VehicleCalibration read_kitti_calibration(const std::filesystem::path& folder) {
  CalibrationFiles files(folder);
  files.read_cameras();
  files.read_mounting();
  return parse_kitti_calibration(files.text);
}

VehicleCalibration read_kitti_mounting(const std::filesystem::path& folder) {
  CalibrationFiles files(folder);
  files.read_scanner();
  VehicleCalibration calibration;
  calibration.T_body_velo = body_velo(files.text);
  if (is_kitti_car(files.text)) describe_kitti_car(calibration);
  return calibration;
}

VehicleCalibration read_kitti_calibration(const std::filesystem::path& folder, const StereoRig& rig,
                                          bool with_velodyne) {
  CalibrationFiles files(folder);
  VehicleCalibration calibration;
  if (with_velodyne || !rig.T_body_left) files.read_mounting();
  if (with_velodyne) calibration.T_body_velo = body_velo(files.text);
  calibration.stereo = mounted(rig, rig.T_body_left ? *rig.T_body_left : body_left(files.text));
  if (is_kitti_car(files.text)) describe_kitti_car(calibration);
  return calibration;
}

StereoRig parse_kitti_rig(std::string_view cam_to_cam, const std::filesystem::path& file) {
  const KeyedText text(cam_to_cam, file);
  StereoRig rig;
  rig.rectified = parse_rectified_pair(text);
  const std::vector<double> size = text.size("S_00");
  if (text.size("S_01") != size) text.fail("S_01", "differs from S_00");
  rig.width = static_cast<int>(size[0]);
  rig.height = static_cast<int>(size[1]);
  rig.left = raw_camera(text, "00");
  rig.right = raw_camera(text, "01");
  const std::vector<double> t = text.numbers("T_01", 3);
  rig.T_right_left.linear() = text.rotation("R_01");
  rig.T_right_left.translation() << t[0], t[1], t[2];
  rig.R_rect_left = text.rotation("R_rect_00");
  rig.R_rect_right = text.rotation("R_rect_01");
  if (const auto problem = problem_of(rig)) {
    throw std::runtime_error("calibration '" + file.string() + "': " + *problem);
  }
  return rig;
}

}  // namespace maploop::sensors
