#include "runtime/vehicle/config/vehicle_config.h"

#include <stdexcept>
#include <string>

#include "estimators/fusion/configuration.h"
#include "runtime/core/config.h"
#include "runtime/vehicle/config/config_tables.h"
#include "sensors/live/endpoint.h"

namespace maploop::vehicle {
namespace {

void read_value(const runtime::ConfigTable& table, const ParameterDescription& parameter,
                ParameterValue& value) {
  const auto read = [&]<class T>(T& own) {
    if constexpr (std::same_as<T, std::int64_t>) {
      int small = static_cast<int>(own);
      table.read(parameter.key, small);
      own = small;
    } else if constexpr (std::same_as<T, std::string>) {
      if (parameter.names.empty()) {
        table.read(parameter.key, own);
      } else {
        table.read_one_of(parameter.key, own, parameter.names);
      }
    } else {
      table.read(parameter.key, own);
    }
  };
  std::visit(read, value);
}

// The names are read first, and the keys that they set may then differ from them.
void read_names(const runtime::ConfigTable& root, VehicleConfig& config) {
  const auto set = [&](const char* key, std::string name, auto set_by_name) {
    root.read(key, name);
    try {
      set_by_name(config, name);
    } catch (const std::invalid_argument& e) {
      root.fail(key, e.what());
    }
  };
  set("configuration", config.configuration, set_configuration);
  set("imu_grade", config.imu_grade, set_imu_grade);
}

}  // namespace

VehicleConfig::VehicleConfig() {
  set_configuration(*this, "auto");
}

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
  const runtime::ConfigTable root = document.root();
  const auto in_file = [&](std::string_view name) {
    return name.empty() ? root : root.table(name);
  };
  read_names(root, config);
  each_part(config, [&](const auto& table, auto& values) {
    const runtime::ConfigTable given = in_file(table.name);
    for (const auto& parameter : table.parameters) {
      ParameterValue value = parameter.value_in(values);
      read_value(given, parameter, value);
      parameter.set(values, value);
      if (given.has(parameter.key)) {
        config.given.insert(std::string(table.name) + '.' + std::string(parameter.key));
      }
    }
  });
  for (const ScheduledThread& thread : scheduled_threads()) {
    read(root.table("scheduling"), thread.key, config.scheduling.*thread.scheduling);
  }
  document.reject_unknown();
  each_part(config, [&](const auto& table, const auto& values) {
    if (const auto problem = problem_of(table, values)) {
      in_file(table.name).fail(problem->key, problem->text);
    }
  });
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
  std::string_view open;
  each_part(config, [&](const auto& table, const auto& values) {
    if (table.name != open) text += "\n[" + std::string(table.name) + "]\n";
    open = table.name;
    for (const auto& parameter : table.parameters) {
      ParameterValue value = parameter.value_in(values);
      if (auto* own = std::get_if<std::string>(&value)) *own = sensors::without_secrets(*own);
      text += std::string(parameter.key) + " = " + text_of(value) + '\n';
    }
  });
  text += "\n[scheduling]\n";
  for (const ScheduledThread& thread : scheduled_threads()) {
    text +=
        std::string(thread.key) + " = " + toml_value(config.scheduling.*thread.scheduling) + '\n';
  }
  return text;
}

}  // namespace maploop::vehicle
