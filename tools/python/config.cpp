// Everything that can be set, by a file and by texts.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "runtime/vehicle/config/vehicle_config.h"
#include "tools/python/module.h"

namespace maploop::python {

void add_config(py::module_& module) {
  using vehicle::VehicleConfig;
  py::class_<VehicleConfig>(module, "Config", R"(Every parameter of maploop.

file: a TOML file; what it does not name keeps its default. CONFIGURATION.md lists every key.
settings: texts "table.key=value", as of --set, in place of what the file says.
topics: texts "sensor=topic" of a bag, as of --topic.
Raises RuntimeError that names the file, line and key.)")
      .def(py::init([](const std::filesystem::path& file, const std::vector<std::string>& settings,
                       const std::vector<std::string>& topics) {
             return vehicle::load_vehicle_config(file, settings, topics);
           }),
           py::arg("file") = "", py::arg("settings") = std::vector<std::string>(),
           py::arg("topics") = std::vector<std::string>())
      .def(
          "toml", [](const VehicleConfig& config) { return vehicle::to_toml(config); },
          "Returns every key with its value, as a file has them.");
}

}  // namespace maploop::python
