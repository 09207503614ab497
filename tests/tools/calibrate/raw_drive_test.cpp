// Tests a drive of raw cameras: images as the raw cameras would have taken them, rectified when
// they are read.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "runtime/vehicle/drivers/stereo_rig_file.h"
#include "sensors/image/png.h"
#include "tests/support/process.h"
#include "tests/support/real_data.h"
#include "tools/calibrate/board.h"

namespace maploop {
namespace {

namespace fs = std::filesystem;
using testing::ProcessResult;

ProcessResult maploop(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), testing::maploop_command());
  return testing::run(arguments);
}

cv::Mat as_cv(const Eigen::Matrix3d& m) {
  return (cv::Mat_<double>(3, 3) << m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0),
          m(2, 1), m(2, 2));
}

// Returns for each pixel of the raw camera its position in the rectified image, computed by OpenCV.
cv::Mat raw_from_rectified(const sensors::StereoRig& rig, bool left) {
  const sensors::CameraModel& c = left ? rig.left : rig.right;
  const sensors::Distortion& d = c.distortion;
  const StereoCalibration& r = rig.rectified;
  std::vector<cv::Point2d> pixels, rectified;
  for (int v = 0; v < rig.height; ++v)
    for (int u = 0; u < rig.width; ++u) pixels.emplace_back(u, v);
  const cv::Mat k = (cv::Mat_<double>(3, 3) << c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1);
  const cv::Mat p = (cv::Mat_<double>(3, 3) << r.fx, 0, r.cx, 0, r.fy, r.cy, 0, 0, 1);
  const cv::Mat coefficients = (cv::Mat_<double>(5, 1) << d.k1, d.k2, d.p1, d.p2, d.k3);
  cv::undistortPoints(pixels, rectified, k, coefficients,
                      as_cv(left ? rig.R_rect_left : rig.R_rect_right), p,
                      {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 1e-10});
  cv::Mat map(rig.height, rig.width, CV_32FC2);
  for (std::size_t i = 0; i < rectified.size(); ++i) {
    map.ptr<cv::Vec2f>()[i] = {static_cast<float>(rectified[i].x),
                               static_cast<float>(rectified[i].y)};
  }
  return map;
}

// Makes the drive as its raw cameras would have recorded it: only images, stamps and mounting.
fs::path make_raw_drive(const fs::path& day, const sensors::StereoRig& rig) {
  const fs::path from = testing::drive_0013(), to = day / "2011_09_26_drive_0013_extract";
  for (const char* name : {"calib_velo_to_cam.txt", "calib_imu_to_velo.txt"})
    fs::copy_file(from.parent_path() / name, day / name);
  for (const bool left : {true, false}) {
    const std::string camera = left ? "image_00" : "image_01";
    fs::create_directories(to / camera / "data");
    fs::copy_file(from / camera / "timestamps.txt", to / camera / "timestamps.txt");
    const cv::Mat map = raw_from_rectified(rig, left);
    for (const auto& entry : fs::directory_iterator(from / camera / "data")) {
      GreyImage image = calibrate::read_image(entry.path());
      cv::Mat raw;
      cv::remap(cv::Mat(image.height, image.width, CV_8UC1, image.pixels.data()), raw, map,
                cv::Mat(), cv::INTER_CUBIC);
      const std::vector<std::uint8_t> png = sensors::encode_png(
          {raw.data, raw.total()}, raw.cols, raw.rows, sensors::PngContent::noise);
      std::ofstream(to / camera / "data" / entry.path().filename(), std::ios::binary)
          .write(reinterpret_cast<const char*>(png.data()),
                 static_cast<std::streamsize>(png.size()));
    }
  }
  return to;
}

struct Score {
  double percent = 0.0, end_point_m = 0.0;  // 100 m segments, one common rotation removed
};

Score score(const fs::path& drive, const fs::path& config, const fs::path& folder) {
  const std::string poses = (folder / "poses.txt").string(), json = (folder / "s.json").string();
  std::vector<std::string> odometry{"odometry", drive.string(), "--poses", poses};
  if (!config.empty()) odometry.insert(odometry.end(), {"--config", config.string()});
  const ProcessResult run = maploop(odometry);
  EXPECT_EQ(run.status, 0) << run.error;
  const auto truth = testing::real_data() / "kitti/drive_0013_truth/velocity_integrated.txt";
  const ProcessResult judged =
      maploop({"evaluate", poses, truth.string(), "--lengths", "100", "--json", json});
  EXPECT_EQ(judged.status, 0) << judged.error;
  const auto result = nlohmann::json::parse(std::ifstream(json));
  const auto& removed = result["common_rotation_removed"];
  return {result["lengths"][0]["common_rotation_removed"]["percent"], removed["end_point_m"]};
}

// The images are interpolated twice, hence the bound of 0.1 percentage points.
TEST(RawDrive, OdometryIsAsAccurateAsOnTheRectifiedImages) {
  MAPLOOP_REQUIRE_DRIVE();
  MAPLOOP_REQUIRE_REAL_DATA();
  const testing::TemporaryFolder day;
  const fs::path kitti = testing::drive_0013().parent_path() / "calib_cam_to_cam.txt";
  const sensors::StereoRig rig = vehicle::read_stereo_rig(kitti);
  const fs::path raw = make_raw_drive(day.path(), rig);

  // The file is as `maploop calibrate` writes it, and is found relative to the configuration's
  // folder.
  std::ofstream(day.path() / "cameras.toml") << vehicle::to_toml(rig);
  std::ofstream(day.path() / "raw.toml") << "[vehicle.camera]\ncalibration = \"cameras.toml\"\n";
  const Score original = score(testing::drive_0013(), {}, day.path());
  const Score rectified = score(raw, day.path() / "raw.toml", day.path());
  std::cout << "original " << original.percent << " %, end " << original.end_point_m
            << " m; raw, rectified here " << rectified.percent << " %, end "
            << rectified.end_point_m << " m\n";
  EXPECT_NEAR(rectified.percent, original.percent, 0.1);
  EXPECT_NEAR(rectified.end_point_m, original.end_point_m, 0.2);

  // Without the calibration the raw images are refused.
  const ProcessResult plain = maploop({"odometry", raw.string()});
  EXPECT_EQ(plain.status, 1);
  EXPECT_NE(plain.error.find("[vehicle.camera] calibration"), std::string::npos) << plain.error;
  // With a calibration for another image size every pair is refused, and the command fails.
  sensors::StereoRig other = rig;
  other.width -= 2;
  std::ofstream(day.path() / "cameras.toml") << vehicle::to_toml(other);
  EXPECT_EQ(
      maploop({"odometry", raw.string(), "--config", (day.path() / "raw.toml").string()}).status,
      1);
}

}  // namespace
}  // namespace maploop
