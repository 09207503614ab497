#include "tests/sensors/folder_forms.h"

#include <fmt/format.h>

#include <fstream>

#include "sensors/replay/files.h"
#include "sensors/replay/timestamps.h"

namespace maploop::testing {
namespace {

namespace fs = std::filesystem;
using sensors::numbered_file;

// Returns every digit of a matrix, row by row.
std::string numbers_of(const Eigen::MatrixXd& m, const char* between) {
  std::string text;
  for (Eigen::Index row = 0; row < m.rows(); ++row)
    for (Eigen::Index column = 0; column < m.cols(); ++column)
      text += (text.empty() ? "" : between) + fmt::format("{:.17g}", m(row, column));
  return text;
}

void link(const fs::path& from, const fs::path& to) {
  fs::create_directories(to.parent_path());
  fs::create_symlink(from, to);
}

std::string nanoseconds(Time stamp) {
  return std::to_string(to_nanoseconds(stamp));
}

std::string seconds(Time stamp) {
  const std::int64_t ns = to_nanoseconds(stamp);
  return fmt::format("{}.{:09}", ns / 1'000'000'000, ns % 1'000'000'000);
}

std::string camera_yaml(const Eigen::Isometry3d& T_B_camera, const StereoCalibration& s) {
  return fmt::format(
      "%YAML:1.0\n\n# General sensor definitions.\nsensor_type: camera\n\nT_BS:\n  cols: 4\n"
      "  rows: 4\n  data: [{}]\n\nrate_hz: 10\nresolution: [{}, {}]\ncamera_model: pinhole\n"
      "intrinsics: [{:.17g}, {:.17g}, {:.17g}, {:.17g}] #fu, fv, cu, cv\n"
      "distortion_model: radial-tangential\ndistortion_coefficients: [0.0, 0.0, 0.0, 0.0]\n",
      numbers_of(T_B_camera.matrix(), ", "), s.width, s.height, s.fx, s.fy, s.cx, s.cy);
}

// Reads the stamps of both cameras as the drive's files say them.
std::vector<Time> stamps_of(const sensors::KittiDrive& drive, const char* sensor) {
  return sensors::read_timestamps(drive.folder() / sensor / "timestamps.txt").stamps;
}

}  // namespace

void write_text(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

void write_as_euroc(const sensors::KittiDrive& drive, const fs::path& root, std::size_t frames) {
  const StereoCalibration& stereo = drive.calibration().stereo;
  const fs::path mav0 = root / "mav0";
  Eigen::Isometry3d T_left_right = Eigen::Isometry3d::Identity();
  T_left_right.translation().x() = stereo.baseline;
  for (const int right : {0, 1}) {
    const std::string camera = right == 0 ? "cam0" : "cam1";
    const char* kitti = right == 0 ? "image_00" : "image_01";
    const auto stamps = stamps_of(drive, kitti);
    std::string list = "#timestamp [ns],filename\r\n";
    for (std::size_t i = 0; i < frames; ++i) {
      const std::string name = nanoseconds(stamps[i]) + ".png";
      list += nanoseconds(stamps[i]) + ',' + name + "\r\n";
      link(drive.folder() / kitti / "data" / numbered_file(i, ".png"),
           mav0 / camera / "data" / name);
    }
    write_text(mav0 / camera / "data.csv", list);
    write_text(
        mav0 / camera / "sensor.yaml",
        camera_yaml(right == 0 ? stereo.T_body_cam : stereo.T_body_cam * T_left_right, stereo));
  }
  std::string rows =
      "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],"
      "a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n";
  const auto imu = drive.imu();
  for (ImuSample s; imu->next(s);) {
    rows += fmt::format("{},0,0,{:.17g},{:.17g},{:.17g},9.81\n", nanoseconds(s.stamp), s.yaw_rate,
                        s.specific_force_forward, s.specific_force_left);
  }
  write_text(mav0 / "imu0/data.csv", rows);
  write_text(mav0 / "imu0/sensor.yaml",
             "%YAML:1.0\nsensor_type: imu\nT_BS:\n  cols: 4\n  rows: 4\n  data: [" +
                 numbers_of(Eigen::Matrix4d::Identity(), ", ") + "]\nrate_hz: 10\n");
}

void write_as_kitti_360(const sensors::KittiDrive& drive, const fs::path& root,
                        std::size_t frames) {
  const std::string name = "2013_05_28_drive_0000_sync";
  const VehicleCalibration& c = drive.calibration();
  const StereoCalibration& s = c.stereo;
  const auto copy_stamps = [&](const char* from, const fs::path& to) {
    std::string text;
    const auto stamps = stamps_of(drive, from);
    for (std::size_t i = 0; i < frames; ++i) text += format_time(stamps[i]) + '\n';
    write_text(to / "timestamps.txt", text);
  };
  for (const char* camera : {"image_00", "image_01"}) {
    const fs::path to = root / "data_2d_raw" / name / camera;
    copy_stamps(camera, to);
    for (std::size_t i = 0; i < frames; ++i)
      link(drive.folder() / camera / "data" / numbered_file(i, ".png"),
           to / "data_rect" / numbered_file(i, ".png"));
  }
  const fs::path scans = root / "data_3d_raw" / name / "velodyne_points";
  const fs::path oxts = root / "data_poses" / name / "oxts";
  copy_stamps("velodyne_points", scans);
  copy_stamps("oxts", oxts);
  for (std::size_t i = 0; i < frames; ++i) {
    link(drive.folder() / "velodyne_points/data" / numbered_file(i, ".bin"),
         scans / "data" / numbered_file(i, ".bin"));
    link(drive.folder() / "oxts/data" / numbered_file(i, ".txt"),
         oxts / "data" / numbered_file(i, ".txt"));
  }
  Eigen::Isometry3d T_imu_body = Eigen::Isometry3d::Identity();
  T_imu_body.linear() = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  const fs::path calibration = root / "calibration";
  const auto upper = [](const Eigen::Isometry3d& T) {
    return numbers_of(T.matrix().topRows<3>(), " ");
  };
  write_text(calibration / "calib_cam_to_pose.txt",
             "image_00: " + upper(T_imu_body * s.T_body_cam) + '\n');
  write_text(calibration / "calib_cam_to_velo.txt",
             upper(c.T_body_velo.inverse() * s.T_body_cam) + '\n');
  const std::string size = fmt::format("{} {}\n", s.width, s.height);
  const auto projection = [&](double offset) {
    return fmt::format("{:.17g} 0 {:.17g} {:.17g} 0 {:.17g} {:.17g} 0 0 0 1 0\n", s.fx, s.cx,
                       offset, s.fy, s.cy);
  };
  write_text(calibration / "perspective.txt",
             "S_rect_00: " + size + "R_rect_00: 1 0 0 0 1 0 0 0 1\nP_rect_00: " + projection(0.0) +
                 "S_rect_01: " + size + "P_rect_01: " + projection(-s.baseline * s.fx));
}

void write_as_lists(const sensors::KittiDrive& drive, const fs::path& root, std::size_t frames) {
  for (const auto& [list, kitti] :
       {std::pair("left", "image_00"), std::pair("right", "image_01")}) {
    const auto stamps = stamps_of(drive, kitti);
    std::string text = "# timestamp filename\n";
    for (std::size_t i = 0; i < frames; ++i) {
      const std::string name = std::string(list) + '/' + seconds(stamps[i]) + ".png";
      text += seconds(stamps[i]) + ' ' + name + '\n';
      link(drive.folder() / kitti / "data" / numbered_file(i, ".png"), root / name);
    }
    write_text(root / (std::string(list) + ".txt"), text);
  }
  const auto stamps = stamps_of(drive, "velodyne_points");
  for (std::size_t i = 0; i < frames; ++i)
    link(drive.folder() / "velodyne_points/data" / numbered_file(i, ".bin"),
         root / "lidar" / (nanoseconds(stamps[i]) + ".bin"));
}

}  // namespace maploop::testing
