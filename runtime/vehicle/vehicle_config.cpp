#include "runtime/vehicle/vehicle_config.h"

#include <array>
#include <charconv>
#include <concepts>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "estimators/fusion/configuration.h"
#include "estimators/lidar/validate.h"
#include "estimators/stereo/validate.h"
#include "mapmatch/validate.h"
#include "msgs/named_enum.h"
#include "ppp/filter/validate.h"
#include "runtime/core/config.h"
#include "runtime/vehicle/config_fields.h"
#include "sensors/live/endpoint.h"

namespace maploop::vehicle {
namespace {

// One of the names of an enumeration.
template <class Enum>
void read_name(const runtime::ConfigTable& table, const char* key, Enum& value) {
  std::string name(name_of(value));
  table.read(key, name);
  const auto found = value_named<Enum>(name);
  if (!found) {
    std::string allowed;
    for (const std::string_view one : names_of(value))
      allowed += (allowed.empty() ? "\"" : ", \"") + std::string(one) + '"';
    table.fail(key, "is \"" + name + "\"; allowed is one of " + allowed);
  }
  value = *found;
}

void read_value(const runtime::ConfigTable& table, const char* key, auto& value) {
  if constexpr (std::same_as<std::remove_cvref_t<decltype(value)>, std::int64_t>) {
    int small = static_cast<int>(value);
    table.read(key, small);
    value = small;
  } else if constexpr (std::same_as<std::remove_cvref_t<decltype(value)>, runtime::Scheduling>) {
    vehicle::read(table, key, value);
  } else if constexpr (std::is_enum_v<std::remove_cvref_t<decltype(value)>>) {
    read_name(table, key, value);
  } else {
    table.read(key, value);
  }
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

std::string number(auto value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

std::string toml_value(const std::string& text) {
  return quoted(sensors::without_secrets(text));
}
std::string toml_value(const std::vector<std::string>& texts) {
  std::string list;
  for (const std::string& text : texts) list += (list.empty() ? "" : ", ") + quoted(text);
  return '[' + list + ']';
}
std::string toml_value(bool value) {
  return value ? "true" : "false";
}
template <NamedEnum Enum>
std::string toml_value(Enum value) {
  return quoted(std::string(name_of(value)));
}
std::string toml_value(std::integral auto value) {
  return number(value);
}
std::string toml_value(double value) {
  std::string text = number(value);
  // TOML takes a number without point and exponent for an integer.
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

// What a table's own rules say beyond types.
void check_values(const VehicleConfig& config, const std::filesystem::path& file) {
  try {
    stereo::validate(config.stereo);
    lidar::validate(config.lidar);
    fusion::check(config.fusion);
    mapmatch::validate(config.mapmatch);
    ppp::validate(config.ppp.filter);
    check(config.preview);
  } catch (const std::invalid_argument& e) {
    throw runtime::ConfigError(file.string() + ": " + e.what());
  }
}

}  // namespace

void set_configuration(VehicleConfig& config, const std::string& name) {
  const fusion::Configuration configuration = fusion::configuration(name);
  config.configuration = configuration.name;
  config.odometry = configuration.lidar ? "visual-lidar" : "visual";
  fusion::apply(configuration, config.fusion);
}

void set_imu_grade(VehicleConfig& config, const std::string& name) {
  fusion::apply_grade(name, config.fusion);
  config.imu_grade = name;
}

void describe_car(VehicleConfig& config, const VehicleCalibration& calibration) {
  const auto take = [&](std::string_view key, double& value, double known) {
    if (!config.given.contains(key)) value = known;
  };
  fusion::FusionParameters& p = config.fusion;
  take("fusion.rear_axle_distance", p.rear_axle_distance, calibration.rear_axle_distance);
  take("fusion.climb_offset", p.climb_offset, calibration.climb_offset);
  take("fusion.climb_offset_sigma", p.climb_offset_sigma, calibration.climb_offset_sigma);
  take("lidar.elevation_correction", config.lidar.elevation_correction, calibration.beam_elevation);
}

VehicleConfig load_vehicle_config(const std::filesystem::path& file) {
  VehicleConfig config;
  const runtime::ConfigDocument document = runtime::ConfigDocument::load(file);
  runtime::ConfigTable table = document.root();
  // First the names, then the keys, which may differ from what the names say.
  std::string configuration = config.configuration, grade = config.imu_grade;
  table.read("configuration", configuration);
  table.read("imu_grade", grade);
  try {
    set_configuration(config, configuration);
    set_imu_grade(config, grade);
  } catch (const std::invalid_argument& e) {
    throw runtime::ConfigError(file.string() + ": " + e.what());
  }
  std::string prefix;
  visit(
      config,
      [&](const char* name) {
        table = document.root().table(name);
        prefix = std::string(name) + '.';
      },
      [&](const char* key, auto& value) {
        read_value(table, key, value);
        if (table.has(key)) config.given.insert(prefix + key);
      });
  document.reject_unknown();
  if (config.odometry != "visual" && config.odometry != "visual-lidar") {
    throw runtime::ConfigError(file.string() + ": odometry = \"" + config.odometry +
                               "\": it must be \"visual\" or \"visual-lidar\"");
  }
  if (!(config.ppp.integrity_risk > 0.0 && config.ppp.integrity_risk < 1.0)) {
    document.root().table("ppp").fail("integrity_risk", "is no probability between 0 and 1");
  }
  if (!(config.ppp.latency >= 0.0 && config.ppp.latency < 10.0)) {
    document.root().table("ppp").fail("latency", "must be 0 to 10 s");
  }
  if (!(config.odometry_poses.speed_sigma > 0.0 && config.odometry_poses.rotation_sigma > 0.0)) {
    document.root()
        .table("odometry_poses")
        .fail("speed_sigma", "must be positive, as rotation_sigma");
  }
  check_values(config, file);
  const auto beside = [&](std::string& path) { path = (file.parent_path() / path).string(); };
  for (std::string* path :
       {&config.camera.calibration, &config.live.calibration, &config.live.velodyne_calibration,
        &config.odometry_poses.file, &config.map.file, &config.map.rules})
    if (!path->empty()) beside(*path);
  for (std::string& product : config.ppp.products) beside(product);
  return config;
}

std::string to_toml(const VehicleConfig& config) {
  std::string text;
  visit(
      config, [&](const char* name) { text += "\n[" + std::string(name) + "]\n"; },
      [&](const char* key, const auto& value) {
        text += std::string(key) + " = " + toml_value(value) + '\n';
      });
  return text;
}

}  // namespace maploop::vehicle
