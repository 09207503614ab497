// Visual and LiDAR odometry, on arrays that stay where they are.
#include <pybind11/stl.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "estimators/lidar/visual_lidar_odometer.h"
#include "estimators/stereo/stereo_odometry.h"
#include "runtime/vehicle/config/vehicle_config.h"
#include "tools/python/arrays.h"

namespace maploop::python {
namespace {

using lidar::ScanView;
using vehicle::VehicleConfig;

Sample sample_at(std::int64_t stamp, std::uint64_t sequence) {
  Sample sample;
  sample.stamp = sample.available = from_nanoseconds(stamp);
  sample.sequence = sequence;
  return sample;
}

class PythonStereo {
 public:
  PythonStereo(const StereoCalibration& calibration, const VehicleConfig& config)
      : calibration_(calibration), odometry_(calibration, config.stereo) {}

  VisualMotion process(const py::array& left, const py::array& right, std::int64_t stamp,
                       std::optional<std::uint64_t> sequence) {
    const stereo::ImageView l = image(left, "left"), r = image(right, "right");
    return alone(mutex_, [&] {
      sequence_ = sequence.value_or(sequence_ + 1);
      return odometry_.process(sample_at(stamp, sequence_), l, r);
    });
  }

  VisualMotion process_pair(const StereoPair& pair) {
    return alone(mutex_, [&] {
      sequence_ = pair.sequence;
      return odometry_.process(pair);
    });
  }

  Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor> tracks() {
    return alone(mutex_, [&] {
      Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor> rows(odometry_.tracks().size(), 4);
      Eigen::Index i = 0;
      for (const stereo::StereoTrack& t : odometry_.tracks())
        rows.row(i++) << t.previous.u_left, t.previous.v_left, t.current.u_left, t.current.v_left;
      return rows;
    });
  }

  double disparity_offset() {
    return alone(mutex_, [&] { return odometry_.disparity_offset(); });
  }

 private:
  stereo::ImageView image(const py::array& pixels, const char* what) const {
    require_array<std::uint8_t>(pixels, what, 2);
    if (pixels.shape(0) != calibration_.height || pixels.shape(1) != calibration_.width) {
      throw py::value_error(std::string(what) + " has " + std::to_string(pixels.shape(1)) + " x " +
                            std::to_string(pixels.shape(0)) + " px; the calibration is of " +
                            std::to_string(calibration_.width) + " x " +
                            std::to_string(calibration_.height) + " px");
    }
    if ((pixels.flags() & py::array::c_style) == 0) {
      throw py::value_error(std::string(what) +
                            " has gaps between its rows; use numpy.ascontiguousarray()");
    }
    return {calibration_.width, calibration_.height,
            static_cast<const std::uint8_t*>(pixels.data())};
  }

  StereoCalibration calibration_;
  std::mutex mutex_;
  stereo::StereoOdometry odometry_;
  std::uint64_t sequence_ = ~std::uint64_t{0};  // of the last pair
};

class PythonLidar {
 public:
  PythonLidar(const Eigen::Matrix4d& T_body_velo, const VehicleConfig& config)
      : odometer_(rigid(T_body_velo, "T_body_velo"), config.lidar) {}

  lidar::OdometerResult process(const py::array& points, std::int64_t stamp,
                                std::optional<std::int64_t> start, std::optional<std::int64_t> end,
                                const std::optional<py::array>& times, const VisualMotion* visual) {
    ScanView scan = view(points, stamp, start, end);
    if (times) {
      require_array<float>(*times, "times", 1);
      if (static_cast<std::size_t>(times->shape(0)) != scan.count ||
          (times->flags() & py::array::c_style) == 0)
        throw py::value_error("times must have one element for each point, without gaps");
      scan.times = static_cast<const float*>(times->data());
    }
    return alone(mutex_, [&] {
      scan.sequence = sequence_++;
      return odometer_.process(scan, visual);
    });
  }

  lidar::OdometerResult process_scan(const LidarScan* scan, const VisualMotion* visual) {
    return alone(mutex_, [&] { return odometer_.process(lidar::view_of(scan), visual); });
  }

  Eigen::Matrix4d pose() {
    return alone(mutex_, [&] { return Eigen::Matrix4d(odometer_.odometry().pose().matrix()); });
  }

  Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> local_map() {
    return alone(mutex_, [&] {
      const auto points = odometer_.odometry().local_map().points();
      Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> rows(points.size(), 3);
      for (std::size_t i = 0; i < points.size(); ++i)
        rows.row(static_cast<Eigen::Index>(i)) = points[i].position.transpose();
      return rows;
    });
  }

 private:
  static ScanView view(const py::array& points, std::int64_t stamp,
                       std::optional<std::int64_t> start, std::optional<std::int64_t> end) {
    require_array<float>(points, "points", 2);
    if (points.shape(1) != 3 && points.shape(1) != 4) {
      throw py::value_error("points has " + std::to_string(points.shape(1)) +
                            " columns; it must have x, y, z, or these and the reflectance");
    }
    if (points.shape(0) == 0) throw py::value_error("points is empty: the scan has no point");
    const py::ssize_t row = points.strides(0), one = sizeof(float);
    if (points.strides(1) != one || row < 3 * one || row % one != 0) {
      throw py::value_error(
          "the values of a point are not beside each other in points; use "
          "numpy.ascontiguousarray()");
    }
    ScanView scan(sample_at(stamp, 0), from_nanoseconds(start.value_or(stamp - 1)),
                  from_nanoseconds(end.value_or(stamp + 1)));
    scan.first = static_cast<const float*>(points.data());
    scan.count = static_cast<std::size_t>(points.shape(0));
    scan.stride = static_cast<std::size_t>(row / one);
    return scan;
  }

  std::mutex mutex_;
  lidar::VisualLidarOdometer odometer_;
  std::uint64_t sequence_ = 0;
};

void add_stereo(py::module_& module) {
  py::class_<PythonStereo>(module, "StereoOdometry", R"(Visual odometry from rectified stereo pairs.

calibration: a StereoCalibration. config: [stereo] of a Config.
Raises ValueError that names a value which is not valid.)")
      .def(py::init<const StereoCalibration&, const VehicleConfig&>(), py::arg("calibration"),
           py::arg("config") = VehicleConfig())
      .def("process", &PythonStereo::process_pair, py::arg("pair"),
           "Returns the VisualMotion since the newest usable pair before this StereoPair.")
      .def("process", &PythonStereo::process, py::arg("left"), py::arg("right"), py::arg("stamp"),
           py::arg("sequence") = py::none(),
           R"(The same for images of your own.

left, right: (height, width) uint8, contiguous; they are not copied. stamp: ns.
sequence: number of the pair; without it, they are counted. A refused pair is no error: the
motion's status tells why. Raises TypeError or ValueError for arrays of another type or shape.)")
      .def("tracks", &PythonStereo::tracks,
           "Returns (n, 4) px: u, v in the left image before and now of the features followed.")
      .def_property_readonly("disparity_offset", &PythonStereo::disparity_offset,
                             "px, estimated so far; the motions include it");
}

void add_lidar(py::module_& module) {
  py::class_<lidar::OdometerResult>(module, "OdometerResult", "The result of a scan.")
      .def_readonly("lidar", &lidar::OdometerResult::lidar, "LidarMotion by the scan")
      .def_readonly("odometry", &lidar::OdometerResult::odometry,
                    "RelativeMotion: that by the scan if it is ok, otherwise the visual one");
  py::class_<PythonLidar>(module, "LidarOdometry", R"(LiDAR odometry by GICP on a local map.

T_body_velo: (4, 4), from the LiDAR to the body. config: [lidar] of a Config.
Raises ValueError that names a value which is not valid.)")
      .def(py::init<const Eigen::Matrix4d&, const VehicleConfig&>(),
           py::arg("T_body_velo") = Eigen::Matrix4d(Eigen::Matrix4d::Identity()),
           py::arg("config") = VehicleConfig())
      .def("process", &PythonLidar::process_scan, py::arg("scan").none(true),
           py::arg("visual") = py::none(),
           R"(Returns the OdometerResult of a LidarScan.

visual: the VisualMotion of the image pair taken during the scan. scan: None if there is none.)")
      .def("process", &PythonLidar::process, py::arg("points"), py::arg("stamp"), py::kw_only(),
           py::arg("start") = py::none(), py::arg("end") = py::none(),
           py::arg("times") = py::none(), py::arg("visual") = py::none(),
           R"(The same for points of your own.

points: (n, 3) or (n, 4) float32, m, velo; they are not copied. stamp: ns, the middle of the turn.
start, end: ns, of a turn from rear to rear, clockwise from above: times come from azimuths.
times: (n,) float32, s after stamp, of each point.
Without start, end and times all points count as measured at stamp. Raises TypeError or ValueError
for arrays of another type or shape, and for no points.)")
      .def_property_readonly("pose", &PythonLidar::pose,
                             "(4, 4), of the body at the last step in its first frame")
      .def("local_map", &PythonLidar::local_map,
           "Returns (n, 3) float32, m: the points of the map, in the body's first frame.");
}

}  // namespace

void add_odometry(py::module_& module) {
  add_stereo(module);
  add_lidar(module);
}

}  // namespace maploop::python
