// The fused filter without threads.
#include <pybind11/stl.h>

#include <array>
#include <mutex>
#include <optional>
#include <string>

#include "estimators/fusion/reduced_imu_filter.h"
#include "runtime/vehicle/config/vehicle_config.h"
#include "tools/python/arrays.h"
#include "tools/python/state_record.h"

namespace maploop::python {
namespace {

using vehicle::VehicleConfig;
using Origin = std::optional<std::array<double, 3>>;

class PythonFilter {
 public:
  PythonFilter(const VehicleConfig& config, const Origin& origin)
      : filter_(config.fusion,
                origin ? std::optional(Geodetic{(*origin)[0], (*origin)[1], (*origin)[2]})
                       : std::nullopt) {}

  // Returns "applied", "held until the filter starts", or the reason of the refusal.
  template <class Measurement>
  std::string_view add(const Measurement& measurement) {
    return words(alone(mutex_, [&] { return filter_.add(measurement); }));
  }

  std::string_view start(std::int64_t stamp, double latitude, double longitude, double height,
                         double azimuth, double speed) {
    fusion::KnownStart known;
    known.stamp = from_nanoseconds(stamp);
    known.position = {latitude, longitude, height};
    known.attitude.azimuth = azimuth;
    known.speed = speed;
    return words(alone(mutex_, [&] { return filter_.start(known); }));
  }

  py::object state_at(std::int64_t stamp) {
    const auto state = alone(mutex_, [&] { return filter_.state_at(from_nanoseconds(stamp)); });
    return state ? scalar_of(record_of(*state)) : py::none();
  }

  bool initialized() {
    return alone(mutex_, [&] { return filter_.initialized(); });
  }

 private:
  static std::string_view words(const fusion::Outcome& outcome) {
    return outcome.refused() ? to_string(outcome.reason) : to_string(outcome.disposition);
  }

  std::mutex mutex_;
  fusion::ReducedImuFilter filter_;
};

}  // namespace

StateRecord record_of(const FusedState& s) {
  StateRecord r{};
  r.stamp = to_nanoseconds(s.stamp);
  r.status = static_cast<std::uint8_t>(s.status);
  const Geodetic place = LocalFrame(s.origin).to_geodetic(s.position_enu);
  r.latitude = place.latitude;
  r.longitude = place.longitude;
  r.height = place.height;
  Eigen::Map<Eigen::Vector3d>(r.position_enu) = s.position_enu;
  Eigen::Map<Eigen::Vector3d>(r.velocity_enu) = s.velocity_enu;
  r.azimuth = s.attitude.azimuth;
  r.pitch = s.attitude.pitch;
  r.roll = s.attitude.roll;
  r.forward_speed = s.forward_speed;
  r.gyro_bias = s.gyro_bias;
  Eigen::Map<Eigen::Matrix<double, 9, 9>>(&r.covariance[0][0]) = s.covariance;
  Eigen::Map<Eigen::Vector3d>(r.odom_position) = s.odom.position;
  r.odom_azimuth = s.odom.attitude.azimuth;
  r.odometry_stamp = to_nanoseconds(s.odometry_stamp);
  r.gnss_stamp = to_nanoseconds(s.gnss_stamp);
  r.wheel_stamp = to_nanoseconds(s.wheel_stamp);
  r.zero_velocity_stamp = to_nanoseconds(s.zero_velocity_stamp);
  return r;
}

void add_fusion(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(StateRecord, stamp, status, latitude, longitude, height, position_enu,
                       velocity_enu, azimuth, pitch, roll, forward_speed, gyro_bias, covariance,
                       odom_position, odom_azimuth, odometry_stamp, gnss_stamp, wheel_stamp,
                       zero_velocity_stamp);
  module.attr("state_dtype") = py::dtype::of<StateRecord>();
  module.attr("NAV_STATUS") = names_tuple<NavStatus>();
  const char* added =
      "Returns \"applied\", \"held until the filter starts\", or why it is refused.";
  py::class_<PythonFilter>(module, "FusionFilter", R"(The extended Kalman filter of the vehicle.

config: [fusion] of a Config; that of a Recording describes its car, too. origin: latitude,
longitude (rad), height (m) of enu; without it, it is where the filter starts.
Samples may come in any order and late; each is applied at its own stamp. Raises ValueError that
names a parameter which is out of its range.)")
      .def(py::init<const VehicleConfig&, const Origin&>(), py::arg("config") = VehicleConfig(),
           py::arg("origin") = py::none())
      .def("add", &PythonFilter::add<ImuSample>, py::arg("sample"), added)
      .def("add", &PythonFilter::add<RelativeMotion>, py::arg("sample"), added)
      .def("add", &PythonFilter::add<WheelSpeed>, py::arg("sample"), added)
      .def("add", &PythonFilter::add<GnssFix>, py::arg("sample"), added)
      .def(
          "start", &PythonFilter::start, py::arg("stamp"), py::arg("latitude"),
          py::arg("longitude"), py::arg("height"), py::arg("azimuth"), py::arg("speed") = 0.0,
          R"(Starts at a known place (rad, rad, m), azimuth (rad) and speed (m/s); returns as add().)")
      .def("state_at", &PythonFilter::state_at, py::arg("stamp"),
           "Returns the state at stamp (ns), an element of state_dtype, or None if there is none.")
      .def_property_readonly("initialized", &PythonFilter::initialized);
}

}  // namespace maploop::python
