#include "msgs/vehicle_description.h"

#include <cmath>

#include "msgs/frames.h"

namespace maploop {
namespace {

using enum Audience;
using namespace std::string_view_literals;

constexpr std::array scanners{"HDL-64E"sv, "HDL-32E"sv, "VLP-16"sv};
constexpr double bus_length = 20.0;  // m, with its trailer

// Returns the axes of a camera that looks forward, in the body's.
Eigen::Isometry3d forward_camera() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return T;
}

void known_pose(const Eigen::Vector3d& position, SensorPosition& p, SensorRotation& r) {
  if (position.isZero()) return;  // axes alone
  p.forward_sigma = p.left_sigma = p.up_sigma = 0.02;
  r.roll_sigma = r.pitch_sigma = r.yaw_sigma = 0.2;
}

}  // namespace

ParameterTable<CarDescription> parameter_table(const CarDescription&) {
  using P = CarDescription;
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"name", &P::name, usual,
       "Name of the car. What maploop replay and maploop live keep of a car (--state) is used only "
       "on a car of the same name."},
      {"side_of_road", one_of<&P::side_of_road>, usual,
       "Side on which traffic keeps. With \"by-map\" it is that of most opposite carriageways of "
       "the map, or right."},
      {"rear_axle_distance", &P::rear_axle_distance, -5.0, 5.0, "m", usual,
       "Distance from the rear axle forward to the body's origin, the inertial unit."},
      {"rear_axle_distance_sigma", &P::rear_axle_distance_sigma, above_zero, 5.0, "m", usual,
       "Its standard deviation."},
      {"rear_axle_height", &P::rear_axle_height, -3.0, 3.0, "m", usual,
       "Height of the rear axle above the body's origin; below it: negative."},
      {"rear_axle_height_sigma", &P::rear_axle_height_sigma, above_zero, 3.0, "m", usual,
       "Its standard deviation."},
      {"wheel_radius", &P::wheel_radius, 0.1, 1.0, "m", usual,
       "Radius of a rear wheel under load."},
      {"wheel_radius_sigma", &P::wheel_radius_sigma, above_zero, 1.0, "m", usual,
       "Its standard deviation."},
      {"track", &P::track, 0.5, 4.0, "m", usual, "Distance between the two rear wheels."},
      {"track_sigma", &P::track_sigma, above_zero, 4.0, "m", usual, "Its standard deviation."},
      {"climb_offset", &P::climb_offset, -1.0, 1.0, "rad", usual,
       "Angle of the direction of travel above the body's x axis, from the mounting of the "
       "inertial unit."},
      {"climb_offset_sigma", &P::climb_offset_sigma, 1e-9, 1.0, "rad", usual,
       "Its standard deviation."},
      {"rear_slip", &P::rear_slip, 0.0, 0.1, "rad/(m/s^2)", usual,
       "Slip angle of the rear tyres by lateral acceleration: passenger cars have 0.003 to 0.009."},
      {"rear_slip_sigma", &P::rear_slip_sigma, 1e-9, 0.1, "rad/(m/s^2)", usual,
       "Its standard deviation."},
  });
  return {"vehicle",
          "The car. What neither this file nor the recording knows has a neutral value and a wide "
          "standard deviation; maploop vehicle asks, checks, draws and converts these tables.",
          table};
}

ParameterTable<CameraDescription> parameter_table(const CameraDescription&) {
  using P = CameraDescription;
  constexpr double side = 16384, focal = 1e5;
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"calibration", &P::calibration, usual,
       "File of maploop calibrate (or calib_cam_to_cam.txt); the path starts from this file's "
       "folder. With it the images are raw, and are rectified as they are read. Empty: they are "
       "rectified already."},
      {"width", &P::width, 0, side, "px", usual, "Width of a rectified image. 0: not known."},
      {"height", &P::height, 0, side, "px", usual, "Height of a rectified image."},
      {"fx", &P::fx, 0.0, focal, "px", usual, "Focal length of a rectified image, in columns."},
      {"fy", &P::fy, 0.0, focal, "px", usual, "The same in rows."},
      {"focal_sigma", &P::focal_sigma, above_zero, focal, "px", usual,
       "Standard deviation of fx and fy."},
      {"cx", &P::cx, -side, 2.0 * side, "px", usual,
       "Column of the principal point of a rectified image."},
      {"cy", &P::cy, -side, 2.0 * side, "px", usual, "Row of the principal point."},
      {"center_sigma", &P::center_sigma, above_zero, side, "px", usual,
       "Standard deviation of cx and cy."},
      {"baseline", &P::baseline, 0.0, 10.0, "m", usual,
       "Distance from the left camera to the right one."},
      {"baseline_sigma", &P::baseline_sigma, above_zero, 10.0, "m", usual,
       "Its standard deviation."},
  });
  constexpr auto rules = [](const P& c) -> std::optional<ParameterProblem> {
    const bool none = c.width == 0 && c.height == 0 && c.fx == 0.0 && c.fy == 0.0;
    const bool all = c.width >= 64 && c.height >= 64 && c.fx >= 1.0 && c.fy >= 1.0;
    if ((none && c.baseline == 0.0) || (all && c.baseline >= 0.01)) return std::nullopt;
    return ParameterProblem{all ? "baseline" : "width",
                            "must be given together with width, height, fx, fy and baseline, as "
                            "those of rectified images (64 px, 1 px and 0.01 m or more), or not "
                            "at all"};
  };
  return {"vehicle.camera", "The stereo camera; its pose is that of the left camera.", table,
          rules};
}

ParameterTable<LidarDescription> parameter_table(const LidarDescription&) {
  using P = LidarDescription;
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"model", &P::model, usual, "Model of the scanner.", scanners},
      {"calibration", &P::calibration, usual,
       "File db.xml of an HDL-64E; the path starts from this file's folder."},
      {"beam_elevation", &P::beam_elevation, -0.1, 0.1, "rad", usual,
       "Angle by which all beams point higher than the scanner states."},
      {"beam_elevation_sigma", &P::beam_elevation_sigma, above_zero, 0.1, "rad", usual,
       "Its standard deviation."},
  });
  return {"vehicle.lidar", "The LiDAR.", table};
}

ParameterTable<SensorPosition> position_table(std::string_view name, std::string_view meaning) {
  using P = SensorPosition;
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"forward", &P::forward, -bus_length, bus_length, "m", usual,
       "Position from the body's origin, forward."},
      {"forward_sigma", &P::forward_sigma, above_zero, bus_length, "m", usual,
       "Its standard deviation."},
      {"left", &P::left, -3.0, 3.0, "m", usual, "The same to the left."},
      {"left_sigma", &P::left_sigma, above_zero, 3.0, "m", usual, "Its standard deviation."},
      {"up", &P::up, -5.0, 5.0, "m", usual, "The same upward."},
      {"up_sigma", &P::up_sigma, above_zero, 5.0, "m", usual, "Its standard deviation."},
  });
  return {name, meaning, table};
}

ParameterTable<SensorRotation> rotation_table(std::string_view name, std::string_view meaning) {
  using P = SensorRotation;
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"roll", &P::roll, -180.0, 180.0, "deg", usual,
       "Rotation about the forward axis, right side down; it is the last of the three."},
      {"roll_sigma", &P::roll_sigma, above_zero, 180.0, "deg", usual, "Its standard deviation."},
      {"pitch", &P::pitch, -90.0, 90.0, "deg", usual,
       "Rotation about the left axis, nose up, after yaw."},
      {"pitch_sigma", &P::pitch_sigma, above_zero, 180.0, "deg", usual, "Its standard deviation."},
      {"yaw", &P::yaw, -180.0, 180.0, "deg", usual, "Rotation about the upward axis, to the left."},
      {"yaw_sigma", &P::yaw_sigma, above_zero, 180.0, "deg", usual, "Its standard deviation."},
  });
  return {name, meaning, table};
}

ParameterTable<SensorTime> time_table(std::string_view name, std::string_view meaning) {
  using P = SensorTime;
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"delay", &P::delay, 0.0, 60.0, "s", usual,
       "Time from the measurement to the stamp that it is given."},
      {"delay_sigma", &P::delay_sigma, above_zero, 60.0, "s", usual, "Its standard deviation."},
  });
  return {name, meaning, table};
}

Eigen::Isometry3d sensor_pose(const SensorPosition& p, const SensorRotation& r) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() =
      rotation_enu_body({azimuth_from_yaw(radians(r.yaw)), radians(r.pitch), radians(r.roll)});
  T.translation() << p.forward, p.left, p.up;
  return T;
}

Eigen::Isometry3d camera_pose(const SensorPosition& p, const SensorRotation& r) {
  return sensor_pose(p, r) * forward_camera();
}

void set_sensor_pose(const Eigen::Isometry3d& T, SensorPosition& p, SensorRotation& r) {
  const Eigen::Matrix3d R = T.linear();
  const double level = std::hypot(R(0, 0), R(1, 0));
  const bool upright = level < 1e-9;  // yaw and roll turn about the same axis: yaw is 0
  r.pitch = degrees(std::atan2(R(2, 0), level));
  r.yaw = upright ? 0.0 : degrees(std::atan2(R(1, 0), R(0, 0)));
  r.roll = degrees(upright ? std::atan2(R(2, 0) > 0.0 ? -R(0, 1) : R(0, 1), R(1, 1))
                           : std::atan2(R(2, 1), R(2, 2)));
  p.forward = T.translation().x();
  p.left = T.translation().y();
  p.up = T.translation().z();
}

void set_camera_pose(const Eigen::Isometry3d& T, SensorPosition& p, SensorRotation& r) {
  set_sensor_pose(T * forward_camera().inverse(), p, r);
}

VehicleDescription description_of(const VehicleCalibration& c) {
  VehicleDescription d;
  d.car.rear_axle_distance = c.rear_axle_distance;
  d.car.climb_offset = c.climb_offset;
  d.car.climb_offset_sigma = c.climb_offset_sigma;
  d.lidar.beam_elevation = c.beam_elevation;
  set_sensor_pose(c.T_body_velo, d.lidar.position, d.lidar.rotation);
  known_pose(c.T_body_velo.translation(), d.lidar.position, d.lidar.rotation);
  const StereoCalibration& s = c.stereo;
  if (s.width == 0) return d;
  CameraDescription& camera = d.camera;
  camera.width = s.width;
  camera.height = s.height;
  camera.fx = s.fx;
  camera.fy = s.fy;
  camera.cx = s.cx;
  camera.cy = s.cy;
  camera.baseline = s.baseline;
  set_camera_pose(s.T_body_cam, camera.position, camera.rotation);
  known_pose(s.T_body_cam.translation(), camera.position, camera.rotation);
  return d;
}

std::string to_toml(const VehicleDescription& description) {
  std::string text, open;
  const VehicleDescription unknown;
  each_table(
      [&](const auto& table, const auto& values, const auto& defaults) {
        const auto differs = [&](const auto* p) {
          return p != nullptr && p->value_in(values) != p->value_in(defaults);
        };
        for (const auto& p : table.parameters) {
          const auto* value = value_of_sigma(table, p);
          const auto* sigma = parameter_named(table, std::string(p.key) + "_sigma");
          if (!differs(&p) && !differs(value) && !differs(sigma)) continue;
          if (table.name != open) text += "\n[" + std::string(table.name) + "]\n";
          open = table.name;
          text += std::string(p.key) + " = " + text_of(p.value_in(values)) + "  # ";
          if (!p.unit.empty() && p.unit != "1") text += std::string(p.unit) + ". ";
          text += std::string(p.meaning) + '\n';
        }
      },
      description, unknown);
  return text;
}

}  // namespace maploop
