// Arrays of NumPy, seen and made without copies.
#pragma once

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "msgs/named_enum.h"
#include "tools/python/module.h"

namespace maploop::python {

// Throws TypeError unless the array has elements of this type, and ValueError unless it has so many
// dimensions. `what` names the argument.
template <class T>
void require_array(const py::array& array, const char* what, int dimensions) {
  if (!py::isinstance<py::array_t<T>>(array)) {
    throw py::type_error(std::string(what) + " has elements of type " +
                         py::str(array.dtype()).cast<std::string>() + "; it must have " +
                         py::str(py::dtype::of<T>()).template cast<std::string>());
  }
  if (array.ndim() != dimensions) {
    throw py::value_error(std::string(what) + " has " + std::to_string(array.ndim()) +
                          " dimensions; it must have " + std::to_string(dimensions));
  }
}

// Returns an array of the elements at `first`, which `owner` keeps.
template <class T>
py::array view_of(T* first, std::vector<py::ssize_t> shape, const py::handle& owner) {
  return py::array_t<T>(std::move(shape), first, owner);
}

// Returns an array that takes over the elements.
template <class T>
py::array_t<T> array_of(std::vector<T> elements) {
  auto kept = std::make_unique<std::vector<T>>(std::move(elements));
  const auto size = static_cast<py::ssize_t>(kept->size());
  T* first = kept->data();
  const py::capsule owner(kept.release(), [](void* p) { delete static_cast<std::vector<T>*>(p); });
  return py::array_t<T>({size}, first, owner);
}

// Returns one element of an array with fields.
template <class Record>
py::object scalar_of(const Record& record) {
  return array_of(std::vector<Record>{record})[py::int_(0)];
}

// Throws ValueError unless the matrix is a rotation and a translation. `what` names the argument.
inline Eigen::Isometry3d rigid(const Eigen::Matrix4d& T, const char* what) {
  const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
  const bool right = T.allFinite() && T.row(3) == Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0) &&
                     (R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-5 &&
                     R.determinant() > 0.0;
  if (!right) {
    throw py::value_error(std::string(what) +
                          " is no rigid motion; it must be [R t; 0 0 0 1] with a rotation R");
  }
  Eigen::Isometry3d rigid;
  rigid.matrix() = T;
  return rigid;
}

// Returns the names of an enumeration, by number.
template <NamedEnum Enum>
py::tuple names_tuple() {
  py::tuple names(count_of<Enum>);
  for (std::size_t i = 0; i < count_of<Enum>; ++i) names[i] = std::string(enum_names<Enum>[i]);
  return names;
}

}  // namespace maploop::python
