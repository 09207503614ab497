// This file contains what the conversions of all types share (internal).
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <maploop_lcm/header_t.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "msgs/sample.h"

namespace maploop {

inline std::int64_t microseconds_of(Time t) {
  return std::chrono::floor<std::chrono::microseconds>(t).time_since_epoch().count();
}

// Throws std::invalid_argument if a stamp cannot hold the value.
inline Time time_of_utime(std::int64_t utime) {
  const std::optional<Time> t = from_microseconds(utime);
  if (!t) {
    throw std::invalid_argument("utime is " + std::to_string(utime) +
                                ", which is not within the years 1970 to 2255");
  }
  return *t;
}

inline maploop_lcm::header_t header_of(const Sample& sample) {
  maploop_lcm::header_t header{};
  header.utime = microseconds_of(sample.stamp);
  header.stamp_ns = to_nanoseconds(sample.stamp);
  header.available_ns = to_nanoseconds(sample.available);
  header.sequence = static_cast<std::int64_t>(sample.sequence);
  return header;
}

inline void set_sample(Sample& sample, const maploop_lcm::header_t& header) {
  sample.stamp = from_nanoseconds(header.stamp_ns);
  sample.available = from_nanoseconds(header.available_ns);
  sample.sequence = static_cast<std::uint64_t>(header.sequence);
}

template <int n>
void write(const Eigen::Matrix<double, n, 1>& v, double (&out)[n]) {
  for (int i = 0; i < n; ++i) out[i] = v(i);
}

template <int n>
void write(const Eigen::Matrix<double, n, n>& m, double (&out)[n][n]) {
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) out[i][j] = m(i, j);
  }
}

template <int n>
void read(const double (&in)[n], Eigen::Matrix<double, n, 1>& v) {
  for (int i = 0; i < n; ++i) v(i) = in[i];
}

template <int n>
void read(const double (&in)[n][n], Eigen::Matrix<double, n, n>& m) {
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) m(i, j) = in[i][j];
  }
}

// Converts an enumeration of a message, which is numbered like ours; `last` is the largest known
// value.
template <class Enumeration>
Enumeration enumerator_from(std::int8_t value, Enumeration last, const char* field) {
  if (value < 0 || value > static_cast<std::int8_t>(last)) {
    throw std::invalid_argument(std::string(field) + " is " + std::to_string(value) +
                                ", which this version does not know");
  }
  return static_cast<Enumeration>(value);
}

template <class In, class Out>
void convert_each(const std::vector<In>& in, std::vector<Out>& out, Out (*convert)(const In&)) {
  out.resize(in.size());
  std::transform(in.begin(), in.end(), out.begin(), convert);
}

}  // namespace maploop
