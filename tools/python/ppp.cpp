// Precise point positioning over files, epoch by epoch.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "ppp/models/geodesy.h"
#include "ppp/ppp_setup.h"
#include "runtime/vehicle/config/vehicle_config.h"
#include "tools/python/arrays.h"

namespace maploop::python {
namespace {

using vehicle::VehicleConfig;

struct PositionRecord {
  std::int64_t stamp;
  std::uint8_t status;
  double latitude, longitude, height;
  double position_ecef[3];
  double covariance[3][3];
  double velocity_ecef[3];
  double clock, zenith_delay, zenith_delay_sigma;
  std::int32_t satellites, integers;
};

PositionRecord record_of(const ppp::PppSolution& s) {
  PositionRecord r{};
  r.stamp = to_nanoseconds(ppp::to_utc(s.time));
  r.status = static_cast<std::uint8_t>(s.status);
  r.latitude = r.longitude = r.height = std::numeric_limits<double>::quiet_NaN();
  if (s.status != PppStatus::none) {
    const Geodetic place = ppp::geodetic_from_ecef(s.position);
    r.latitude = place.latitude;
    r.longitude = place.longitude;
    r.height = place.height;
  }
  Eigen::Map<Eigen::Vector3d>(r.position_ecef) = s.position;
  Eigen::Map<Eigen::Matrix3d>(&r.covariance[0][0]) = s.covariance;
  Eigen::Map<Eigen::Vector3d>(r.velocity_ecef) = s.velocity;
  r.clock = s.clock;
  r.zenith_delay = s.zenith_delay;
  r.zenith_delay_sigma = s.zenith_delay_sigma;
  r.satellites = s.satellites_used;
  r.integers = s.integers.used;
  return r;
}

class PythonPpp {
 public:
  PythonPpp(const std::vector<std::filesystem::path>& files, const VehicleConfig& config) {
    const py::gil_scoped_release released;
    for (const auto& file : files) ppp::read_into(file, files_);
    for (const auto& product : config.ppp.products) ppp::read_products(product, files_);
    ppp::SetupOptions options;
    options.parameters = config.ppp.filter;
    options.broadcast = config.ppp.broadcast;
    setup_.emplace(files_, options);
    filter_.emplace(setup_->make_filter());
  }

  std::size_t size() const { return setup_->observations().epochs.size(); }
  const std::vector<std::string>& missing_models() const { return setup_->missing_models(); }

  py::object next() {
    const std::vector<PositionRecord> one = positions(1);
    if (one.empty()) throw py::stop_iteration();
    return scalar_of(one.front());
  }
  py::array run() { return array_of(positions(size())); }

 private:
  std::vector<PositionRecord> positions(std::size_t most) {
    return alone(mutex_, [&] {
      std::vector<PositionRecord> records;
      for (; next_ < size() && records.size() < most; ++next_)
        records.push_back(record_of(filter_->process(setup_->observations().epochs[next_])));
      return records;
    });
  }

  ppp::GnssFiles files_;
  std::optional<ppp::PppSetup> setup_;
  std::mutex mutex_;
  std::optional<ppp::PppFilter> filter_;
  std::size_t next_ = 0;  // epoch
};

}  // namespace

void add_ppp(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(PositionRecord, stamp, status, latitude, longitude, height, position_ecef,
                       covariance, velocity_ecef, clock, zenith_delay, zenith_delay_sigma,
                       satellites, integers);
  module.attr("position_dtype") = py::dtype::of<PositionRecord>();
  module.attr("PPP_STATUS") = names_tuple<PppStatus>();
  py::class_<PythonPpp>(module, "PppFilter", R"(Precise point positioning of one receiver.

files: one file of RINEX observations and its products (navigation, SP3, clocks, ANTEX, biases,
earth rotation, ocean loading), in any order. config: [ppp] of a Config.
Iterating gives the position of one epoch after the other, elements of position_dtype. Raises
RuntimeError that names the file, or what is missing.)")
      .def(py::init(
               [](const std::vector<std::filesystem::path>& files, const VehicleConfig& config) {
                 return std::make_unique<PythonPpp>(files, config);
               }),
           py::arg("files"), py::arg("config") = VehicleConfig())
      .def("__len__", &PythonPpp::size, "Returns the number of epochs.")
      .def("__iter__", [](const py::object& self) { return self; })
      .def("__next__", &PythonPpp::next)
      .def("run", &PythonPpp::run, "Returns (n,) position_dtype of all epochs that are left.")
      .def_property_readonly("missing_models", &PythonPpp::missing_models,
                             "sentences: what the models lack");
}

}  // namespace maploop::python
