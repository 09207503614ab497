#include <cmath>

#include "msgs/frames.h"
#include "runtime/vehicle/drivers/stereo_rig_file.h"
#include "sensors/velodyne/lasers.h"
#include "tools/vehicle/vehicle_tool.h"

namespace maploop::vehicle_tool {
namespace {

class Look {
 public:
  explicit Look(const vehicle::VehicleConfig& config) : config_(config) {}

  Findings at() && {
    const VehicleDescription& d = config_.vehicle;
    each_table([&](const auto& table, const auto& values) { missing(table, values); }, d);
    lever("vehicle.camera", d.camera.position);
    lever("vehicle.lidar", d.lidar.position);
    lever("vehicle.antenna", d.antenna.position);
    axes(d);
    calibrations(d);
    return std::move(found_);
  }

 private:
  // Notes values that are not given, and those without the standard deviation.
  template <class P>
  void missing(const ParameterTable<P>& table, const P& values) {
    for (const Parameter<P>& sigma : table.parameters) {
      const Parameter<P>* value = value_of_sigma(table, sigma);
      if (value == nullptr || config_.is_given(table.name, sigma.key)) continue;
      const std::string key(value->key);
      const std::string assumed = text_of(sigma.value_in(values)) + ' ' + std::string(sigma.unit);
      if (config_.is_given(table.name, key)) {
        warn(table.name,
             key + " is given without " + std::string(sigma.key) + ": " + assumed + " is assumed");
        continue;
      }
      const bool new_table = table.name != open_;
      if (new_table) found_.assumed.push_back('[' + std::string(table.name) + "] ");
      open_ = table.name;
      found_.assumed.back() +=
          (new_table ? "" : ", ") + key + ' ' + text_of(value->value_in(values)) + " +-" + assumed;
    }
  }

  void lever(std::string_view table, const SensorPosition& p) {
    if (std::abs(p.forward) > 4.0 || std::abs(p.left) > 1.2 || p.up > 3.0 || p.up < -1.5)
      warn(table,
           "is outside of a passenger car; are forward, left and up metres from the inertial "
           "unit?");
  }

  void axes(const VehicleDescription& d) {
    const Eigen::Matrix3d camera = camera_pose(d.camera.position, d.camera.rotation).linear();
    if (camera(0, 2) < 0.0) warn("vehicle.camera", "looks backwards (yaw)");
    if (camera(2, 1) > 0.0) warn("vehicle.camera", "is upside down (roll)");
    if (sensor_pose(d.lidar.position, d.lidar.rotation).linear()(2, 2) < 0.0)
      warn("vehicle.lidar", "is upside down (roll)");
    const SensorRotation& imu = d.imu.rotation;
    constexpr double misaligned = 10.0;  // deg
    if (std::abs(imu.roll) > misaligned || std::abs(imu.pitch) > misaligned ||
        std::abs(imu.yaw) > misaligned)
      warn("vehicle.imu",
           "is turned by more than 10 deg: samples of a drive of tables (imu.csv) are turned into "
           "the body's axes by it, those of any other unit are not; mount such a unit along them, "
           "or let it turn its samples itself");
  }

  void calibrations(const VehicleDescription& d) {
    if (!d.camera.calibration.empty()) vehicle::read_stereo_rig(d.camera.calibration);
    const auto model = sensors::velodyne_model(d.lidar.model);
    if (!d.lidar.calibration.empty())
      sensors::read_velodyne_calibration(d.lidar.calibration, model.value());
    if (vehicle::has_pose(config_, "vehicle.camera") && d.camera.width == 0 &&
        d.camera.calibration.empty())
      warn("vehicle.camera", "has neither a calibration nor the intrinsics of rectified images");
  }

  void warn(std::string_view table, const std::string& what) {
    found_.warnings.push_back('[' + std::string(table) + "] " + what);
  }

  const vehicle::VehicleConfig& config_;
  Findings found_;
  std::string_view open_;
};

}  // namespace

Findings look_at(const vehicle::VehicleConfig& config) {
  return Look(config).at();
}

}  // namespace maploop::vehicle_tool
