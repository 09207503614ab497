// Opens recordings, and iterates over their samples.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <functional>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "runtime/vehicle/graph/sensors.h"
#include "sensors/source.h"
#include "tools/python/arrays.h"
#include "tools/python/opened_recording.h"

namespace maploop::python {
namespace {

using MakeObject = std::function<py::object()>;

// A sensor's samples, one ahead.
struct Stream {
  virtual ~Stream() = default;
  // Returns when the next sample becomes available; nothing at the end.
  virtual std::optional<Time> available() = 0;
  // Returns what makes the Python object of that sample.
  virtual MakeObject take() = 0;
};

template <class T>
class StreamOf final : public Stream {
 public:
  explicit StreamOf(std::unique_ptr<sensors::Source<T>> source) : source_(std::move(source)) {}

  std::optional<Time> available() override {
    if (next_ == nullptr && !ended_) {
      next_ = std::make_shared<T>();
      ended_ = !source_->next(*next_);
    }
    return ended_ ? std::nullopt : std::optional(next_->available);
  }
  MakeObject take() override {
    return [sample = std::exchange(next_, nullptr)] { return py::cast(sample); };
  }

 private:
  std::unique_ptr<sensors::Source<T>> source_;
  std::shared_ptr<T> next_;
  bool ended_ = false;
};

// Iterates over the samples of one or several sensors in the order in which they are available.
class Samples {
 public:
  explicit Samples(std::vector<std::unique_ptr<Stream>> streams) : streams_(std::move(streams)) {}

  py::object next() {
    const MakeObject make = alone(mutex_, [this]() -> MakeObject {
      Stream* first = nullptr;
      std::optional<Time> least;
      for (const auto& stream : streams_) {
        const std::optional<Time> t = stream->available();
        if (!t || (least && *least <= *t)) continue;
        least = t;
        first = stream.get();
      }
      return first != nullptr ? first->take() : MakeObject();
    });
    if (!make) throw py::stop_iteration();
    return make();
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Stream>> streams_;
};

// Returns the streams of all sensors, or of those that deliver a T.
template <class T = void>
std::unique_ptr<Samples> samples(const OpenedRecording& opened) {
  const py::gil_scoped_release released;
  std::vector<std::unique_ptr<Stream>> streams;
  opened.recording.sensors(Time::min())
      .each_source([&]<class S>(std::unique_ptr<sensors::Source<S>>& s) {
        // The observations of a receiver are PppFilter's.
        if constexpr (!std::is_same_v<S, vehicle::GnssEpoch> &&
                      (std::is_void_v<T> || std::is_same_v<S, T>))
          streams.push_back(std::make_unique<StreamOf<S>>(std::move(s)));
      });
  return std::make_unique<Samples>(std::move(streams));
}

OpenedRecording open(const std::filesystem::path& path, vehicle::VehicleConfig config) {
  const py::gil_scoped_release released;
  const vehicle::KnownContents contents = vehicle::fit_to_recording(config, path);
  vehicle::Recording recording = vehicle::open_recording(path, config, contents);
  describe_car(config, recording.calibration);
  config.vehicle.imu.time.delay = config.replay.imu_delay;  // as the recording was read
  return {std::move(config), path, std::move(recording)};
}

}  // namespace

void add_recording(py::module_& module) {
  py::class_<Samples>(module, "Samples", "Iterates over samples of a recording.")
      .def("__iter__", [](const py::object& self) { return self; })
      .def("__next__", &Samples::next);
  py::class_<OpenedRecording>(module, "Recording",
                              R"(A recorded drive in any form that maploop opens.

path: a KITTI drive, KITTI-360, EuRoC, a folder of images, clouds or tables, a ROS bag, an MCAP
file, a capture of a Velodyne scanner, or a log (sensors/FORMATS.md).
config: a Config, which the recording completes.
Iterating gives every sample of all sensors in the order in which they become available. Raises
RuntimeError that names the file and what is wrong with it.)")
      .def(py::init(&open), py::arg("path"), py::arg("config") = vehicle::VehicleConfig())
      .def_property_readonly(
          "config", [](const OpenedRecording& r) { return r.config; },
          "the Config, with what the recording says of the car")
      .def_property_readonly(
          "stereo", [](const OpenedRecording& r) { return r.recording.calibration.stereo; },
          "the StereoCalibration of its images")
      .def_property_readonly(
          "T_body_velo",
          [](const OpenedRecording& r) {
            return Eigen::Matrix4d(r.recording.calibration.T_body_velo.matrix());
          },
          "(4, 4), from the LiDAR to the body")
      .def_property_readonly(
          "first_stamp",
          [](const OpenedRecording& r) { return to_nanoseconds(r.recording.first_stamp); },
          "ns, of the images; if there are none, of epochs or scans")
      .def_property_readonly(
          "last_stamp",
          [](const OpenedRecording& r) { return to_nanoseconds(r.recording.last_stamp); }, "ns")
      .def_property_readonly(
          "notes", [](const OpenedRecording& r) { return r.recording.notes; },
          "sentences: what is not used, what was assumed")
      .def("__iter__", &samples<>)
      .def("images", &samples<StereoPair>, "Iterates over the StereoPair samples.")
      .def("scans", &samples<LidarScan>, "Iterates over the LidarScan samples.")
      .def("imu", &samples<ImuSample>, "Iterates over the ImuSample samples.")
      .def("gnss", &samples<GnssFix>, "Iterates over the GnssFix samples.")
      .def("wheels", &samples<WheelSpeed>, "Iterates over the WheelSpeed samples.")
      .def("reference", &samples<ReferencePose>, "Iterates over the ReferencePose samples.");
}

}  // namespace maploop::python
