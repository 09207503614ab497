// The parts of the Python module, and what they share.
#pragma once

#include <pybind11/pybind11.h>

#include <mutex>
#include <utility>

namespace maploop::python {

namespace py = pybind11;

// Each adds its classes and functions to the module. The later ones use the classes of the earlier.
void add_config(py::module_& module);
void add_samples(py::module_& module);
void add_recording(py::module_& module);
void add_odometry(py::module_& module);
void add_fusion(py::module_& module);
void add_matching(py::module_& module);
void add_ppp(py::module_& module);
void add_replay(py::module_& module);

// Calls f() without Python's lock, so that other Python threads go on, and with that of the object,
// because no C++ object is used by two threads at a time. `f` must not touch Python.
template <class F>
auto alone(std::mutex& object, F&& f) {
  const py::gil_scoped_release released;
  const std::lock_guard lock(object);
  return std::forward<F>(f)();
}

}  // namespace maploop::python
