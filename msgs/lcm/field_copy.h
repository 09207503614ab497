// This file copies the members of a struct to the fields of its message, or back (internal). One
// description serves both directions; it fixes names, units and enumerations:
//
//   void convert(auto copy, Is<WheelSpeed> auto& wheel, auto& m) {
//     copy.header(wheel, m.header);
//     copy(wheel.speed, m.speed);
//   }
//   MAPLOOP_CONVERSIONS(WheelSpeed, maploop_lcm::wheel_speed_t)  // defines to_lcm() and from_lcm()
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <chrono>
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "msgs/named_enum.h"
#include "msgs/time.h"

namespace maploop {

template <class T, class Value>
concept Is = std::same_as<std::remove_const_t<T>, Value>;

// --- These functions copy one value; both directions have an overload.

template <class From, class To>
requires std::is_arithmetic_v<From> && std::is_arithmetic_v<To>
void assign(const From& from, To& to) {
  to = static_cast<To>(from);
}

template <class T>
requires(!std::is_arithmetic_v<T>) void assign(const T& from, T& to) {
  to = from;
}

inline void assign(Time from, std::int64_t& ns) {
  ns = to_nanoseconds(from);
}
inline void assign(std::int64_t ns, Time& to) {
  to = from_nanoseconds(ns);
}

inline void assign(Duration from, std::int64_t& ns) {
  ns = from.count();
}
inline void assign(std::int64_t ns, Duration& to) {
  to = Duration(ns);
}

template <class T, std::size_t n>
void assign(const std::array<T, n>& from, T (&to)[n]) {
  std::copy(from.begin(), from.end(), to);
}
template <class T, std::size_t n>
void assign(const T (&from)[n], std::array<T, n>& to) {
  std::copy(from, from + n, to.begin());
}

template <int n>
void assign(const Eigen::Matrix<double, n, 1>& from, double (&to)[n]) {
  Eigen::Map<Eigen::Matrix<double, n, 1>>{to} = from;
}
template <int n>
void assign(const double (&from)[n], Eigen::Matrix<double, n, 1>& to) {
  to = Eigen::Map<const Eigen::Matrix<double, n, 1>>(from);
}

template <int n>
void assign(const Eigen::Matrix<double, n, n>& from, double (&to)[n][n]) {
  Eigen::Map<Eigen::Matrix<double, n, n, Eigen::RowMajor>>{to[0]} = from;
}
template <int n>
void assign(const double (&from)[n][n], Eigen::Matrix<double, n, n>& to) {
  to = Eigen::Map<const Eigen::Matrix<double, n, n, Eigen::RowMajor>>(from[0]);
}

// In each member function the value comes first and the field of the message second. What reads a
// message throws std::invalid_argument if a field has a value that the struct cannot hold.
template <bool direction_to_message>
struct FieldCopy {
  static constexpr bool to_message = direction_to_message;

  void operator()(auto& value, auto& field) const {
    if constexpr (to_message) {
      assign(value, field);
    } else {
      assign(field, value);
    }
  }

  // Copies an enumeration, whose values are numbered alike in the message; `name` is the field's.
  template <class Enum>
  void choice(Enum& value, auto& field, const char* name) const {
    if constexpr (to_message) {
      field = static_cast<std::int8_t>(value);
    } else {
      if (field < 0 || static_cast<std::size_t>(field) >= count_of<Enum>) {
        throw std::invalid_argument(std::string(name) + " is " + std::to_string(field) +
                                    ", which this version does not know");
      }
      value = static_cast<Enum>(field);
    }
  }

  void header(auto& sample, auto& h) const {
    if constexpr (to_message) utime(sample.stamp, h.utime);
    (*this)(sample.stamp, h.stamp_ns);
    (*this)(sample.available, h.available_ns);
    (*this)(sample.sequence, h.sequence);
  }

  void place(auto& geodetic, auto& latitude, auto& longitude, auto& height) const {
    (*this)(geodetic.latitude, latitude);
    (*this)(geodetic.longitude, longitude);
    (*this)(geodetic.height, height);
  }

  void utime(auto& time, auto& microseconds) const {
    if constexpr (to_message) {
      microseconds = std::chrono::floor<std::chrono::microseconds>(time).time_since_epoch().count();
    } else {
      const std::optional<Time> read = from_microseconds(microseconds);
      if (!read) {
        throw std::invalid_argument("utime is " + std::to_string(microseconds) +
                                    ", which is not within the years 1970 to 2255");
      }
      time = *read;
    }
  }

  void microseconds(auto& duration, auto& us) const {
    if constexpr (to_message) {
      us = static_cast<double>(duration.count()) * 1e-3;
    } else {
      duration = checked_seconds(us * 1e-6);
    }
  }

  void seconds(auto& duration, auto& s) const {
    if constexpr (to_message) {
      s = to_seconds(duration);
    } else {
      duration = checked_seconds(s);
    }
  }

  // NaN stands for nothing.
  void optional(auto& value, auto& field) const {
    if constexpr (to_message) {
      field = value.value_or(std::numeric_limits<double>::quiet_NaN());
    } else if (field == field) {
      value = field;
    }
  }

  // Copies a sequence and its length, which the message has as a field.
  void each(auto& values, auto& fields, auto& length) const {
    resize(values, fields);
    if constexpr (to_message) length = static_cast<std::int32_t>(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      if constexpr (requires { convert(*this, values[i], fields[i]); }) {
        convert(*this, values[i], fields[i]);
      } else {
        (*this)(values[i], fields[i]);
      }
    }
  }

  // Copies one member of each element of a sequence; the message has a sequence of that member.
  void column(auto& values, auto member, auto& fields) const {
    resize(values, fields);
    for (std::size_t i = 0; i < values.size(); ++i) (*this)(values[i].*member, fields[i]);
  }

 private:
  static void resize(auto& values, auto& fields) {
    if constexpr (to_message) {
      fields.resize(values.size());
    } else {
      values.resize(fields.size());
    }
  }
};

#define MAPLOOP_CONVERSIONS(Value, Message)      \
  Message to_lcm(const Value& value) {           \
    Message message{};                           \
    convert(FieldCopy<true>{}, value, message);  \
    return message;                              \
  }                                              \
  Value from_lcm(const Message& message) {       \
    Value value;                                 \
    convert(FieldCopy<false>{}, value, message); \
    return value;                                \
  }

}  // namespace maploop
