// Binds the samples of sensors and the motions of odometries. Their arrays are views of the C++
// samples.
#include <memory>
#include <string>

#include "msgs/calibration.h"
#include "msgs/gnss.h"
#include "msgs/image.h"
#include "msgs/imu.h"
#include "msgs/lidar_scan.h"
#include "msgs/reference.h"
#include "msgs/visual_motion.h"
#include "msgs/wheel_speed.h"
#include "tools/python/arrays.h"

namespace maploop::python {
namespace {

template <class T>
using Class = py::class_<T, std::shared_ptr<T>>;

// Adds the stamps, which every sample has.
template <class T>
Class<T> sample(py::module_& module, const char* name, const char* says) {
  return Class<T>(module, name, says)
      .def_property_readonly(
          "stamp", [](const T& s) { return to_nanoseconds(s.stamp); }, "ns, when it was measured")
      .def_property_readonly(
          "available", [](const T& s) { return to_nanoseconds(s.available); },
          "ns, when the sensor delivers it")
      .def_property_readonly(
          "sequence", [](const T& s) { return s.sequence; },
          "number of the sample in its source; a gap is a loss");
}

// Makes a sample that is available when it is measured.
template <class T>
std::shared_ptr<T> stamped(std::int64_t stamp, std::uint64_t sequence) {
  auto made = std::make_shared<T>();
  made->stamp = made->available = from_nanoseconds(stamp);
  made->sequence = sequence;
  return made;
}

py::array pixels(const py::object& owner, GreyImage& image) {
  return view_of(image.pixels.data(), {image.height, image.width}, owner);
}

void add_images(py::module_& module) {
  sample<StereoPair>(module, "StereoPair", "A rectified pair of grey images.")
      .def_property_readonly(
          "left",
          [](const py::object& self) { return pixels(self, self.cast<StereoPair&>().left); },
          "(height, width) uint8, a view")
      .def_property_readonly(
          "right",
          [](const py::object& self) { return pixels(self, self.cast<StereoPair&>().right); },
          "(height, width) uint8, a view");
  Class<StereoCalibration>(module, "StereoCalibration", R"(A rectified pair of cameras.

width, height, fx, fy, cx, cy: px. baseline: m, from the left camera to the right.
T_body_cam: (4, 4), from the left camera to the body.)")
      .def(py::init([](int width, int height, double fx, double fy, double cx, double cy,
                       double baseline, const Eigen::Matrix4d& T_body_cam) {
             return StereoCalibration{width, height, fx,       fy,
                                      cx,    cy,     baseline, rigid(T_body_cam, "T_body_cam")};
           }),
           py::kw_only(), py::arg("width"), py::arg("height"), py::arg("fx"), py::arg("fy"),
           py::arg("cx"), py::arg("cy"), py::arg("baseline"),
           py::arg("T_body_cam") = Eigen::Matrix4d(Eigen::Matrix4d::Identity()))
      .def_readonly("width", &StereoCalibration::width, "px")
      .def_readonly("height", &StereoCalibration::height, "px")
      .def_readonly("fx", &StereoCalibration::fx, "px")
      .def_readonly("fy", &StereoCalibration::fy, "px")
      .def_readonly("cx", &StereoCalibration::cx, "px")
      .def_readonly("cy", &StereoCalibration::cy, "px")
      .def_readonly("baseline", &StereoCalibration::baseline, "m")
      .def_property_readonly(
          "T_body_cam",
          [](const StereoCalibration& c) { return Eigen::Matrix4d(c.T_body_cam.matrix()); },
          "(4, 4)");
}

void add_scans(py::module_& module) {
  sample<LidarScan>(module, "LidarScan", "One turn of a LiDAR; its stamp is the middle.")
      .def_property_readonly(
          "start", [](const LidarScan& s) { return to_nanoseconds(s.start); }, "ns")
      .def_property_readonly(
          "end", [](const LidarScan& s) { return to_nanoseconds(s.end); }, "ns")
      .def_property_readonly(
          "points",
          [](const py::object& self) {
            auto& points = self.cast<LidarScan&>().points;
            return view_of(reinterpret_cast<float*>(points.data()),
                           {static_cast<py::ssize_t>(points.size()), 4}, self);
          },
          "(n, 4) float32, a view: x, y, z (m, velo, as measured), reflectance (0 to 1)");
}

void add_inertial(py::module_& module) {
  sample<ImuSample>(module, "ImuSample", R"(A sample of the inertial unit, in body axes.

specific_force: (3,) m/s^2, forward, left and up; level and at rest it is (0, 0, 9.8).
angular_rate: (3,) rad/s about x, y and z; turning left is positive about z.
six_axes: whether force up, roll and pitch rate are measured; otherwise they are not used.)")
      .def(py::init([](std::int64_t stamp, const Eigen::Vector3d& force,
                       const Eigen::Vector3d& rate, bool six_axes, std::uint64_t sequence) {
             auto s = stamped<ImuSample>(stamp, sequence);
             s->values() = {force.x(), force.y(), rate.z(), six_axes,
                            force.z(), rate.x(),  rate.y()};
             if (!six_axes) s->specific_force_up = s->roll_rate = s->pitch_rate = 0.0;
             return s;
           }),
           py::arg("stamp"), py::arg("specific_force"), py::arg("angular_rate"), py::kw_only(),
           py::arg("six_axes") = true, py::arg("sequence") = 0)
      .def_property_readonly(
          "specific_force",
          [](const ImuSample& s) {
            return Eigen::Vector3d(s.specific_force_forward, s.specific_force_left,
                                   s.specific_force_up);
          },
          "(3,) m/s^2, body")
      .def_property_readonly(
          "angular_rate",
          [](const ImuSample& s) { return Eigen::Vector3d(s.roll_rate, s.pitch_rate, s.yaw_rate); },
          "(3,) rad/s, body")
      .def_property_readonly("six_axes", [](const ImuSample& s) { return s.six_axes; });
  sample<WheelSpeed>(module, "WheelSpeed", "Speed along the path and its standard deviation, m/s.")
      .def(py::init([](std::int64_t stamp, double speed, double sigma, std::uint64_t sequence) {
             auto s = stamped<WheelSpeed>(stamp, sequence);
             s->speed = speed;
             s->sigma = sigma;
             return s;
           }),
           py::arg("stamp"), py::arg("speed"), py::arg("sigma"), py::kw_only(),
           py::arg("sequence") = 0)
      .def_readonly("speed", &WheelSpeed::speed, "m/s, negative in reverse")
      .def_readonly("sigma", &WheelSpeed::sigma, "m/s");
}

// Adds the place of a sample that has one.
template <class T>
Class<T> place(Class<T> of) {
  return of
      .def_property_readonly(
          "latitude", [](const T& s) { return s.position.latitude; }, "rad")
      .def_property_readonly(
          "longitude", [](const T& s) { return s.position.longitude; }, "rad")
      .def_property_readonly(
          "height", [](const T& s) { return s.position.height; }, "m above the ellipsoid")
      .def_readonly("velocity_enu", &T::velocity_enu, "(3,) m/s")
      .def_property_readonly(
          "velocity_stamp", [](const T& s) { return to_nanoseconds(s.velocity_stamp); }, "ns");
}

void add_places(py::module_& module) {
  place(sample<GnssFix>(module, "GnssFix", R"(A receiver's position and velocity.

latitude, longitude: rad, WGS84. height: m above the ellipsoid. velocity_enu: (3,) m/s.
position_covariance: (3, 3) m^2, east north up. velocity_covariance: (3, 3) m^2/s^2.)"))
      .def(py::init([](std::int64_t stamp, double latitude, double longitude, double height,
                       const Eigen::Matrix3d& position_covariance, const Eigen::Vector3d& velocity,
                       const Eigen::Matrix3d& velocity_covariance, std::uint64_t sequence) {
             auto s = stamped<GnssFix>(stamp, sequence);
             s->position = {latitude, longitude, height};
             s->position_covariance = position_covariance;
             s->velocity_stamp = s->stamp;
             s->velocity_enu = velocity;
             s->velocity_covariance = velocity_covariance;
             return s;
           }),
           py::arg("stamp"), py::arg("latitude"), py::arg("longitude"), py::arg("height"),
           py::kw_only(), py::arg("position_covariance"), py::arg("velocity_enu"),
           py::arg("velocity_covariance"), py::arg("sequence") = 0)
      .def_readonly("position_covariance", &GnssFix::position_covariance, "(3, 3) m^2")
      .def_readonly("velocity_covariance", &GnssFix::velocity_covariance, "(3, 3) m^2/s^2");
  place(sample<ReferencePose>(module, "ReferencePose",
                              "The recording's own pose, to score with; never an input."))
      .def_property_readonly(
          "azimuth", [](const ReferencePose& s) { return s.attitude.azimuth; }, "rad")
      .def_property_readonly(
          "pitch", [](const ReferencePose& s) { return s.attitude.pitch; }, "rad, nose up")
      .def_property_readonly(
          "roll", [](const ReferencePose& s) { return s.attitude.roll; }, "rad, right side down")
      .def_readonly("position_accuracy", &ReferencePose::position_accuracy, "m, as stated");
}

void add_motions(py::module_& module) {
  sample<RelativeMotion>(module, "RelativeMotion", R"(The motion of the body since from_stamp.

T: (4, 4), the pose of the body at stamp in the body frame at from_stamp. covariance: (6, 6),
translation (m), then rotation vector (rad), in the same frame. Both are valid if ok is true;
otherwise status tells why not.)")
      .def_property_readonly("ok",
                             [](const RelativeMotion& m) { return m.status == OdometryStatus::ok; })
      .def_property_readonly(
          "status", [](const RelativeMotion& m) { return to_string(m.status); }, "in words")
      .def_property_readonly(
          "condition", [](const RelativeMotion& m) { return to_string(m.condition); }, "in words")
      .def_property_readonly(
          "from_stamp", [](const RelativeMotion& m) { return to_nanoseconds(m.from); }, "ns")
      .def_property_readonly(
          "T", [](const RelativeMotion& m) { return Eigen::Matrix4d(m.T_from_to().matrix()); },
          "(4, 4)")
      .def_readonly("covariance", &RelativeMotion::covariance, "(6, 6)")
      .def_property_readonly(
          "source", [](const RelativeMotion& m) { return to_string(m.source); },
          "visual, lidar or visual-lidar")
      .def_readonly("tracked", &RelativeMotion::tracked, "features, or points of surfaces, offered")
      .def_readonly("inliers", &RelativeMotion::inliers, "those that agree");
  py::class_<VisualMotion, RelativeMotion, std::shared_ptr<VisualMotion>>(
      module, "VisualMotion", "The motion found by StereoOdometry.")
      .def_readonly("offset", &VisualMotion::offset, "px, added to all disparities")
      .def_readonly("offset_sigma", &VisualMotion::offset_sigma, "px");
  py::class_<LidarMotion, RelativeMotion, std::shared_ptr<LidarMotion>>(
      module, "LidarMotion", "The motion found by the registration of a scan.")
      .def_readonly("iterations", &LidarMotion::iterations, "of the registration");
}

}  // namespace

void add_samples(py::module_& module) {
  add_images(module);
  add_scans(module);
  add_inertial(module);
  add_places(module);
  add_motions(module);
}

}  // namespace maploop::python
