#include "sensors/replay/kitti_calibration.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "tests/sensors/small_drive.h"
#include "tests/support/error_of.h"

namespace maploop::sensors {
namespace {

using ::testing::HasSubstr;

struct Texts {
  std::string cam_to_cam = cam_to_cam_text();
  std::string velo_to_cam = velo_to_cam_text();
  std::string imu_to_velo = imu_to_velo_text();
};

VehicleCalibration parse(const Texts& t) {
  return parse_kitti_calibration(
      {t.cam_to_cam, t.velo_to_cam, t.imu_to_velo, "cams.txt", "velo.txt", "imu.txt"});
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("not in the text: " + from);
  return text.replace(at, from.size(), to);
}

std::string error_in(const Texts& texts) {
  return maploop::testing::error_of([&] { parse(texts); });
}

// A point in front of the car is taken through the printed matrices one after the other.
TEST(KittiCalibration, ChainsTheThreeFilesAsPrinted) {
  const VehicleCalibration c = parse({});
  Eigen::Matrix3d R_imu_to_velo, R_velo_to_cam, R_rect;
  R_imu_to_velo << 9.999976e-01, 7.553071e-04, -2.035826e-03, -7.854027e-04, 9.998898e-01,
      -1.482298e-02, 2.024406e-03, 1.482454e-02, 9.998881e-01;
  R_velo_to_cam << 7.533745e-03, -9.999714e-01, -6.166020e-04, 1.480249e-02, 7.280733e-04,
      -9.998902e-01, 9.998621e-01, 7.523790e-03, 1.480755e-02;
  R_rect << 9.999239e-01, 9.837760e-03, -7.445048e-03, -9.869795e-03, 9.999421e-01, -4.278459e-03,
      7.402527e-03, 4.351614e-03, 9.999631e-01;
  const Eigen::Vector3d p_body(20.0, 3.0, 1.0);
  const Eigen::Vector3d p_velo =
      R_imu_to_velo * p_body + Eigen::Vector3d(-8.086759e-01, 3.195559e-01, -7.997231e-01);
  const Eigen::Vector3d p_cam =
      R_rect *
      (R_velo_to_cam * p_velo + Eigen::Vector3d(-4.069766e-03, -7.631618e-02, -2.717806e-01));
  EXPECT_LT((c.T_body_velo * p_velo - p_body).norm(), 1e-5);
  EXPECT_LT((c.stereo.T_body_cam * p_cam - p_body).norm(), 1e-5);
}

TEST(KittiCalibration, RecognizesOnlyTheCarOfKitti) {
  const VehicleCalibration kitti = parse({});
  EXPECT_EQ(kitti.rear_axle_distance, -0.28);
  EXPECT_EQ(kitti.climb_offset, 0.0084);
  EXPECT_EQ(kitti.climb_offset_sigma, 0.0087);
  EXPECT_EQ(kitti.beam_elevation, 0.00357792);
  Texts texts;
  texts.imu_to_velo = replaced(texts.imu_to_velo, "25-May-2012 16:47:16", "simulated");
  const VehicleCalibration other = parse(texts);
  EXPECT_EQ(other.rear_axle_distance, 0.0);
  EXPECT_EQ(other.climb_offset, 0.0);
  EXPECT_EQ(other.beam_elevation, 0.0);
}

// The sketch of the car (IJRR 2013, fig. 3) has the LiDAR 0.81 m in front and 0.32 m to the right
// of the IMU, the camera another 0.27 m ahead; heights above the road are 1.65 m camera, 1.73 m
// LiDAR, 0.93 m IMU.
TEST(KittiCalibration, AgreesWithTheSketchOfTheCar) {
  const VehicleCalibration c = parse({});
  const Eigen::Vector3d cam = c.stereo.T_body_cam.translation();
  EXPECT_NEAR(cam.x(), 0.81 + 0.27, 0.02);
  EXPECT_NEAR(cam.y(), -0.32, 0.02);
  EXPECT_NEAR(cam.z(), 1.65 - 0.93, 0.02);
  const Eigen::Vector3d velo = c.T_body_velo.translation();
  EXPECT_NEAR(velo.x(), 0.81, 0.02);
  EXPECT_NEAR(velo.y(), -0.32, 0.02);
  EXPECT_NEAR(velo.z(), 1.73 - 0.93, 0.02);
  // The camera's z points ahead, its x to the right, its y down (within a degree of the body).
  const Eigen::Matrix3d R = c.stereo.T_body_cam.linear();
  EXPECT_GT(R(0, 2), 0.9998);
  EXPECT_LT(R(1, 0), -0.9998);
  EXPECT_LT(R(2, 1), -0.9998);
}

TEST(KittiCalibration, IntrinsicsAndBaseline) {
  const StereoCalibration s = parse({}).stereo;
  EXPECT_EQ(s.width, 32);
  EXPECT_EQ(s.height, 24);
  EXPECT_DOUBLE_EQ(s.fx, 721.5377);
  EXPECT_DOUBLE_EQ(s.fy, 721.5377);
  EXPECT_DOUBLE_EQ(s.cx, 609.5593);
  EXPECT_DOUBLE_EQ(s.cy, 172.854);
  EXPECT_NEAR(s.baseline, 387.5744 / 721.5377, 1e-12);
}

TEST(KittiCalibration, RotationsAreOrthonormalInSpiteOfTheRoundingInTheText) {
  const VehicleCalibration c = parse({});
  for (const Eigen::Isometry3d& T : {c.stereo.T_body_cam, c.T_body_velo}) {
    EXPECT_LT((T.linear() * T.linear().transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_NEAR(T.linear().determinant(), 1.0, 1e-14);
  }
}

TEST(KittiCalibration, AcceptsCrlf) {
  Texts texts;
  for (std::string* text : {&texts.cam_to_cam, &texts.velo_to_cam, &texts.imu_to_velo}) {
    for (std::size_t at = 0; (at = text->find('\n', at)) != std::string::npos; at += 2) {
      text->replace(at, 1, "\r\n");
    }
  }
  EXPECT_EQ(parse(texts).stereo.T_body_cam.matrix(), parse({}).stereo.T_body_cam.matrix());
}

TEST(KittiCalibration, NamesFileAndKeyOfWhatIsWrong) {
  struct Case {
    std::string Texts::*text;
    const char *from, *to, *file, *key, *reason;
  };
  const Case cases[] = {
      {&Texts::cam_to_cam, "P_rect_01", "P_rect_09", "cams.txt", "'P_rect_01'", "missing"},
      {&Texts::cam_to_cam, "S_rect_00:", "S_rect_00 ", "cams.txt", "'S_rect_00'", "missing"},
      {&Texts::cam_to_cam, "R_rect_00: 9.999239e-01 ", "R_rect_00: ", "cams.txt", "'R_rect_00'",
       "8 numbers instead of 9"},
      {&Texts::cam_to_cam, "R_rect_00: 9.999239e-01 ", "R_rect_00: 0.9 ", "cams.txt", "'R_rect_00'",
       "not a rotation"},
      {&Texts::cam_to_cam, "S_rect_00: 3.2", "S_rect_00: 3.25", "cams.txt", "'S_rect_00'", "size"},
      {&Texts::cam_to_cam, "S_rect_01: 3.2", "S_rect_01: 3.3", "cams.txt", "'S_rect_01'",
       "differs"},
      {&Texts::cam_to_cam, "-3.875744e+02", "3.875744e+02", "cams.txt", "'P_rect_01'", "baseline"},
      {&Texts::cam_to_cam, "P_rect_01: 7.2", "P_rect_01: 7.1", "cams.txt", "'P_rect_01'",
       "intrinsics"},
      {&Texts::cam_to_cam, "P_rect_00: 7.215377e+02", "P_rect_00: nan", "cams.txt", "'P_rect_00'",
       "not a finite number: 'nan'"},
      {&Texts::velo_to_cam, "T:", "t:", "velo.txt", "'T'", "missing"},
      {&Texts::velo_to_cam, "delta_f:", "R:", "velo.txt", "'R'", "twice"},
      {&Texts::imu_to_velo, "-8.086759e-01", "oops", "imu.txt", "'T'", "'oops'"},
      {&Texts::imu_to_velo, "-8.086759e-01", "-8.086759e+02", "imu.txt", "'T'", "longer than 10 m"},
      {&Texts::imu_to_velo, "R: 9.999976e-01", "R: inf", "imu.txt", "'R'", "not a finite number"},
  };
  for (const Case& c : cases) {
    Texts texts;
    texts.*c.text = replaced(texts.*c.text, c.from, c.to);
    const std::string error = error_in(texts);
    for (const char* part : {c.file, c.key, c.reason}) EXPECT_THAT(error, HasSubstr(part));
  }
}

TEST(KittiCalibration, AMirrorIsNotARotation) {
  Texts texts;
  texts.velo_to_cam = "R: 1 0 0 0 1 0 0 0 -1\nT: 0 0 0\n";
  EXPECT_THAT(error_in(texts), HasSubstr("not a rotation"));
}

}  // namespace
}  // namespace maploop::sensors
