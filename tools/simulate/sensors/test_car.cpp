#include "tools/simulate/sensors/test_car.h"

#include "sensors/replay/kitti_calibration.h"
#include "tools/simulate/output_file.h"
#include "tools/simulate/random.h"

namespace maploop::simulate {
namespace {

constexpr const char* cam_to_cam =
    R"(calib_time: simulated
S_rect_00: 1.242000e+03 3.750000e+02
R_rect_00: 1 0 0 0 1 0 0 0 1
P_rect_00: 7.215377e+02 0 6.095593e+02 0 0 7.215377e+02 1.728540e+02 0 0 0 1 0
S_rect_01: 1.242000e+03 3.750000e+02
R_rect_01: 1 0 0 0 1 0 0 0 1
P_rect_01: 7.215377e+02 0 6.095593e+02 -3.875744e+02 0 7.215377e+02 1.728540e+02 0 0 0 1 0
)";
constexpr const char* velo_to_cam =
    R"(calib_time: simulated
R: 0 -1 0 0 0 -1 1 0 0
T: 0 -0.08 -0.27
)";
constexpr const char* imu_to_velo =
    R"(calib_time: simulated
R: 1 0 0 0 1 0 0 0 1
T: -0.81 0.32 -0.8
)";

}  // namespace

VehicleCalibration test_car() {
  return sensors::parse_kitti_calibration({cam_to_cam, velo_to_cam, imu_to_velo, "calib_cam_to_cam",
                                           "calib_velo_to_cam", "calib_imu_to_velo"});
}

void write_calibration(const std::filesystem::path& folder) {
  write_file(folder / "calib_cam_to_cam.txt", cam_to_cam);
  write_file(folder / "calib_velo_to_cam.txt", velo_to_cam);
  write_file(folder / "calib_imu_to_velo.txt", imu_to_velo);
}

CalibrationErrors calibration_errors(std::uint64_t seed) {
  Random random(seed, 32);
  CalibrationErrors errors;
  const float mean = random.uniform_float(0.30, 0.48);
  ColumnShift& lack = errors.disparity_lack;
  lack.slope = random.uniform_float(-0.2, 0.2);
  lack.bowl = random.uniform_float(0.3, 0.7);
  lack.middle = mean - lack.bowl / 3.0F;
  errors.range_scale = static_cast<float>(0.002 * random.normal());
  errors.scanner_unit = random.bits();
  errors.scanner_phase = random.uniform(0.0, 0.1);
  errors.scanner_drift = random.uniform(-200e-6, 200e-6);
  return errors;
}

}  // namespace maploop::simulate
