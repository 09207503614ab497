#include "sensors/bag/cloud_messages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <stdexcept>
#include <string>

#include "msgs/input_limits.h"
#include "sensors/cloud/time_unit.h"

namespace maploop::sensors {
namespace {

// Reads one number at a place in a point.
using ReadNumber = double (*)(const std::uint8_t* point);

template <class T, bool swapped>
double read_number(const std::uint8_t* point) {
  std::array<std::uint8_t, sizeof(T)> raw;
  std::memcpy(raw.data(), point, sizeof(T));
  if constexpr (swapped) std::reverse(raw.begin(), raw.end());
  T value;
  std::memcpy(&value, raw.data(), sizeof(T));
  return static_cast<double>(value);
}

struct FieldType {
  std::size_t bytes;
  ReadNumber little, big;
};

template <class T>
constexpr FieldType field_type{sizeof(T), read_number<T, false>, read_number<T, true>};

// By sensor_msgs/PointField's numbers from 1 on.
constexpr std::array types{field_type<std::int8_t>,  field_type<std::uint8_t>,
                           field_type<std::int16_t>, field_type<std::uint16_t>,
                           field_type<std::int32_t>, field_type<std::uint32_t>,
                           field_type<float>,        field_type<double>};

struct FieldReader {
  std::size_t offset = 0;
  ReadNumber read = nullptr;

  bool is_float() const { return read == &read_number<float, false>; }
  double operator()(const std::uint8_t* point) const { return read(point + offset); }
  float as_float(const std::uint8_t* point, bool known_float) const {
    if (!known_float) return static_cast<float>(read(point + offset));
    float value;  // which is what nearly every driver writes, and four times as fast
    std::memcpy(&value, point + offset, sizeof value);
    return value;
  }
};

std::optional<FieldReader> find_field(const RosPointCloud& cloud,
                                      std::initializer_list<std::string_view> names) {
  for (const RosPointField& field : cloud.fields) {
    if (std::ranges::count(names, field.name) == 0) continue;
    if (field.datatype < 1 || field.datatype > types.size()) continue;
    const FieldType& type = types[field.datatype - 1U];
    if (field.offset > cloud.point_step || type.bytes > cloud.point_step - field.offset) {
      throw std::invalid_argument("its field " + std::string(field.name) +
                                  " is beyond a point of " + std::to_string(cloud.point_step) +
                                  " bytes");
    }
    return FieldReader{field.offset, cloud.big_endian ? type.big : type.little};
  }
  return std::nullopt;
}

FieldReader need_field(const RosPointCloud& cloud, std::string_view name) {
  const auto field = find_field(cloud, {name});
  if (!field) throw std::invalid_argument("it has no field " + std::string(name));
  return *field;
}

// Converts times since the stamp or since 1970, in an unknown unit. Equal times, as of a flash, are
// none.
void set_times(const std::vector<double>& raw, Time stamp, std::vector<Time>& times) {
  const auto [least, most] = std::ranges::minmax(raw);
  const auto unit = time_unit(most - least);
  if (!unit) return;
  constexpr double year_1973 = 1e8, year_2200 = 7e9, most_apart = 10.0;  // s
  const bool since_1970 = least * *unit > year_1973;
  const double largest = std::max(std::abs(least), std::abs(most)) * *unit;
  if (largest > (since_1970 ? year_2200 : most_apart)) return;
  const Time origin = since_1970 ? Time{} : stamp;
  times.resize(raw.size());
  std::transform(raw.begin(), raw.end(), times.begin(),
                 [&](double value) { return origin + from_seconds(value * *unit); });
}

void check_size(const RosPointCloud& m) {
  const std::uint64_t count = std::uint64_t{m.width} * m.height;
  if (m.data.size() > input_limits::cloud || m.point_step == 0 ||
      count > m.data.size() / m.point_step) {
    throw std::invalid_argument(std::to_string(m.data.size()) + " bytes are not " +
                                std::to_string(m.height) + " x " + std::to_string(m.width) +
                                " points of " + std::to_string(m.point_step) + " bytes");
  }
  if (m.height > 1 && (m.row_step < std::uint64_t{m.width} * m.point_step ||
                       m.row_step > m.data.size() / m.height)) {
    throw std::invalid_argument("its rows of " + std::to_string(m.row_step) + " bytes do not fit");
  }
}

}  // namespace

void read_cloud(const RosPointCloud& m, TimedCloud& cloud) {
  check_size(m);
  const FieldReader x = need_field(m, "x"), y = need_field(m, "y"), z = need_field(m, "z");
  const auto reflectance = find_field(m, {"intensity", "reflectivity", "reflectance", "i"});
  const auto time =
      find_field(m, {"t", "time", "timestamp", "time_offset", "time_stamp", "ts", "offset_time"});
  cloud.points.clear();
  cloud.times.clear();
  cloud.dropped = 0;
  std::vector<double> raw;
  const FieldReader& i = reflectance ? *reflectance : x;
  const bool floats = x.is_float() && y.is_float() && z.is_float() && i.is_float();
  for (std::size_t v = 0; v < m.height; ++v) {
    const std::uint8_t* point = m.data.data() + (m.height > 1 ? v * m.row_step : 0);
    for (std::size_t u = 0; u < m.width; ++u, point += m.point_step) {
      const LidarPoint p{x.as_float(point, floats), y.as_float(point, floats),
                         z.as_float(point, floats), reflectance ? i.as_float(point, floats) : 0.0F};
      const double t = time ? (*time)(point) : 0.0;
      // A scanner marks a missing return by the origin, or by numbers that are not finite.
      const bool missing = p.x == 0.0F && p.y == 0.0F && p.z == 0.0F;
      if (missing || !std::isfinite(p.x + p.y + p.z + p.reflectance) || !std::isfinite(t)) {
        cloud.dropped += missing ? 0 : 1;
        continue;
      }
      cloud.points.push_back(p);
      if (time) raw.push_back(t);
    }
  }
  if (cloud.points.empty()) throw std::invalid_argument("it has no finite point");
  if (time) set_times(raw, m.header.stamp, cloud.times);
}

}  // namespace maploop::sensors
