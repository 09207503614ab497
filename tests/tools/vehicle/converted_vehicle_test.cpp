// Tests the conversion of the calibrations of datasets.
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/error_of.h"
#include "tests/support/real_data.h"
#include "tools/vehicle/vehicle_tool.h"

namespace maploop::vehicle_tool {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using testing::error_of;
using ::testing::HasSubstr;

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

void write(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file) << text;
}

// In KITTI-360's format: the camera looks forward from 1.57 m ahead and 0.65 m above.
struct Kitti360 {
  testing::TemporaryFolder folder;
  std::string pose =
      "image_00: 0.03717833 -0.09861821 0.9944306 1.5752681 0.99926755 -0.00535534 -0.03789026 "
      "0.00439141 0.00906218 0.99511093 0.09834688 -0.65\nimage_01: 1 0 0 0 0 1 0 0 0 0 1 0\n";
  std::string velo = "0 0 1 0.8 -1 0 0 0.1 0 -1 0 -0.2\n";
  std::string perspective =
      "S_rect_00: 1408 376\nR_rect_00: 1 0 0 0 1 0 0 0 1\n"
      "P_rect_00: 552.55 0 682.05 0 0 552.55 238.77 0 0 0 1 0\nS_rect_01: 1408 376\n"
      "P_rect_01: 552.55 0 682.05 -328.32 0 552.55 238.77 0 0 0 1 0\n";

  Converted convert() const {
    const fs::path calibration = folder.path() / "calibration";
    write(calibration / "calib_cam_to_pose.txt", pose);
    write(calibration / "calib_cam_to_velo.txt", velo);
    write(calibration / "perspective.txt", perspective);
    return from_kitti_360(folder.path());
  }
};

std::string camera_yaml(const std::string& pose, const std::string& intrinsics) {
  return "# General sensor definitions.\nsensor_type: camera\n\nT_BS:\n  cols: 4\n  rows: 4\n"
         "  data: [" +
         pose +
         ",\n         0.0, 0.0, 0.0, 1.0]\n\nrate_hz: 20\n"
         "resolution: [752, 480]\ncamera_model: pinhole\n" +
         intrinsics;
}

// The calibration of EuRoC's stereo camera and inertial unit.
struct Euroc {
  testing::TemporaryFolder folder;
  std::string left = camera_yaml(
      "0.0148655429818, -0.999880929698, 0.00414029679422, -0.0216401454975,\n"
      "         0.999557249008, 0.0149672133247, 0.025715529948, -0.064676986768,\n"
      "        -0.0257744366974, 0.00375618835797, 0.999660727178, 0.00981073058949",
      "intrinsics: [458.654, 457.296, 367.215, 248.375] #fu, fv, cu, cv\n"
      "distortion_model: radial-tangential\n"
      "distortion_coefficients: [-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05]\n");
  std::string right = camera_yaml(
      "0.0125552670891, -0.999755099723, 0.0182237714554, -0.0198435579556,\n"
      "         0.999598781151, 0.0130119051815, 0.0251588363115, 0.0453689425024,\n"
      "        -0.0253898008918, 0.0179005838253, 0.999517347078, 0.00786212447038",
      "intrinsics: [457.587, 456.134, 379.999, 255.238]\n"
      "distortion_model: radial-tangential\n"
      "distortion_coefficients: [-0.28368365, 0.07451284, -0.00010473, -3.55590700e-05]\n");
  std::string imu = "T_BS:\n  data: [1.0, 0, 0, 0, 0, 1.0, 0, 0, 0, 0, 1.0, 0, 0, 0, 0, 1.0]\n";

  Converted convert() const {
    write(folder.path() / "mav0/cam0/sensor.yaml", left);
    write(folder.path() / "mav0/cam1/sensor.yaml", right);
    write(folder.path() / "mav0/imu0/sensor.yaml", imu);
    return from_euroc(folder.path());
  }
};

TEST(Converted, KittiIsTheCarOfItsSketch) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const VehicleDescription d = from_kitti(testing::real_data() / "kitti/2011_09_26").description;
  EXPECT_NEAR(d.camera.position.forward, 1.08, 0.02);
  EXPECT_NEAR(d.camera.position.left, -0.32, 0.02);
  EXPECT_NEAR(d.lidar.position.up, 0.80, 0.02);
  EXPECT_NEAR(d.camera.rotation.yaw, 0.0, 1.0);
  EXPECT_NEAR(d.camera.baseline, 0.5372, 1e-4);
  EXPECT_EQ(d.car.rear_axle_distance, -0.28);
  EXPECT_EQ(d.car.rear_axle_distance_sigma, 0.1);
  EXPECT_EQ(d.imu.time.delay, 0.06);
  EXPECT_EQ(d.lidar.model, "HDL-64E");
}

TEST(Converted, Kitti360HasItsAxesTurned) {
  const VehicleDescription d = Kitti360{}.convert().description;
  const SensorPosition& camera = d.camera.position;
  EXPECT_NEAR(camera.forward, 1.5752681, 1e-9);
  EXPECT_NEAR(camera.left, -0.00439141, 1e-9);
  EXPECT_NEAR(camera.up, 0.65, 1e-9);
  EXPECT_NEAR(d.camera.rotation.yaw, 2.2, 0.1) << "to the left, where KITTI-360's y is negative";
  EXPECT_NEAR(d.camera.rotation.pitch, -5.6, 0.1) << "it looks down a little";
  EXPECT_NEAR(d.lidar.position.forward, 1.5752681 - 0.8, 0.1);
  EXPECT_NEAR(d.lidar.position.up, 0.65 + 0.2, 0.15);
  EXPECT_EQ(d.camera.width, 1408);
  EXPECT_NEAR(d.camera.baseline, 328.32 / 552.55, 1e-12);
}

TEST(Converted, EurocsCameraLooksForward) {
  const Converted converted = Euroc{}.convert();
  const VehicleDescription& d = converted.description;
  EXPECT_THAT(converted.note, HasSubstr("are z, -y, x of EuRoC's B"));
  EXPECT_NEAR(d.camera.position.forward, 0.00981, 1e-5);
  EXPECT_NEAR(d.camera.position.left, 0.06468, 1e-5);
  EXPECT_NEAR(d.camera.position.up, -0.02164, 1e-5);
  for (const double angle :
       {d.camera.rotation.roll, d.camera.rotation.pitch, d.camera.rotation.yaw})
    EXPECT_LT(std::abs(angle), 3.0);
  ASSERT_TRUE(converted.cameras);
  EXPECT_NEAR(converted.cameras->rectified.baseline, 0.11, 1e-3);
  EXPECT_FALSE(problem_of(*converted.cameras));
  // The axes of the inertial unit are EuRoC's B.
  Eigen::Matrix3d R_body_imu;
  R_body_imu << 0, 0, 1, 0, -1, 0, 1, 0, 0;
  EXPECT_TRUE(sensor_pose({}, d.imu.rotation).linear().isApprox(R_body_imu, 1e-12));
}

TEST(Converted, EveryErrorNamesFileAndKey) {
  const auto kitti_360 = [](auto&& damage) {
    Kitti360 files;
    damage(files);
    return error_of([&] { files.convert(); });
  };
  const auto euroc = [](auto&& damage) {
    Euroc files;
    damage(files);
    return error_of([&] { files.convert(); });
  };
  const auto in = [](const char* file, const char* key, const char* problem) {
    return AllOf(HasSubstr(file), HasSubstr(key), HasSubstr(problem));
  };
  EXPECT_THAT(kitti_360([](Kitti360& k) { k.velo = replaced(k.velo, "-1", "1"); }),
              in("calib_cam_to_velo.txt", "cam_to_velo", "mirrored"));
  EXPECT_THAT(kitti_360([](Kitti360& k) { k.velo = replaced(k.velo, "0.8", "80"); }),
              in("calib_cam_to_velo.txt", "cam_to_velo", "is longer than 10 m"));
  EXPECT_THAT(kitti_360([](Kitti360& k) { k.pose = replaced(k.pose, "image_00", "image_0"); }),
              in("calib_cam_to_pose.txt", "image_00", "is missing"));
  EXPECT_THAT(kitti_360([](Kitti360& k) {
                k.perspective = replaced(k.perspective, "R_rect_00: 1", "R_rect_00: 2");
              }),
              in("perspective.txt", "R_rect_00", "is not a rotation matrix"));
  EXPECT_THAT(euroc([](Euroc& e) { e.left = replaced(e.left, "T_BS", "T_SB"); }),
              in("cam0/sensor.yaml", "T_BS", "is missing"));
  EXPECT_THAT(euroc([](Euroc& e) { e.right = replaced(e.right, "0.999598", "-0.999598"); }),
              in("cam1/sensor.yaml", "T_BS", "mirrored"));
  EXPECT_THAT(euroc([](Euroc& e) { e.imu = replaced(e.imu, "[1.0", "[-1.0"); }),
              in("imu0/sensor.yaml", "T_BS", "mirrored"));
  EXPECT_THAT(euroc([](Euroc& e) { e.left = replaced(e.left, "0.00981073058949,", ""); }),
              in("cam0/sensor.yaml", "T_BS", "numbers"));
  EXPECT_THAT(euroc([](Euroc& e) { e.left = replaced(e.left, "458.654", "wide"); }),
              in("cam0/sensor.yaml", "intrinsics", "wide"));
  EXPECT_THAT(euroc([](Euroc& e) { e.left = replaced(e.left, "[458.654", "458.654"); }),
              in("cam0/sensor.yaml", "intrinsics", "has no list of numbers"));
  EXPECT_THAT(
      euroc([](Euroc& e) { e.left = replaced(e.left, "radial-tangential", "omnidirectional"); }),
      in("cam0/sensor.yaml", "distortion_model", "is neither radial-tangential nor equidistant"));
  EXPECT_THAT(euroc([](Euroc& e) { e.right = replaced(e.right, "752", "640"); }),
              in("cam1/sensor.yaml", "resolution", "differs from cam0's"));
  EXPECT_THAT(euroc([](Euroc& e) {
                e.left = replaced(e.left, "752", "-1");
                e.right = replaced(e.right, "752", "-1");
              }),
              in("cam0/sensor.yaml", "resolution", "16 to 16384 px"));
  EXPECT_THAT(euroc([](Euroc& e) {
                e.left = camera_yaml(
                    "0.70710678, -0.70710678, 0, 0, 0.70710678, 0.70710678, 0, 0, 0, 0, 1, 0",
                    e.left.substr(e.left.find("intrinsics")));
              }),
              in("cam0/sensor.yaml", "T_BS", "turns the camera by 45 deg or more"));
  EXPECT_THAT(error_of([] { from_euroc("/nowhere"); }), HasSubstr("/nowhere/cam0/sensor.yaml"));
  EXPECT_THAT(error_of([] { from_kitti("/nowhere"); }), HasSubstr("/nowhere/calib_cam_to_cam.txt"));
}

}  // namespace
}  // namespace maploop::vehicle_tool
