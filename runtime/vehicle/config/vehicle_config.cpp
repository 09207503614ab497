#include "runtime/vehicle/config/vehicle_config.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "estimators/fusion/configuration.h"
#include "ppp/ppp_setup.h"
#include "runtime/core/config.h"
#include "runtime/vehicle/config/config_tables.h"
#include "sensors/live/endpoint.h"

namespace maploop::vehicle {
namespace {

constexpr auto moved_keys = std::to_array<runtime::MovedKey>({
    {"camera.calibration", "vehicle.camera.calibration"},
    {"live.calibration",
     "[vehicle.camera] and [vehicle.lidar], which 'maploop vehicle convert kitti' writes"},
    {"live.camera_delay", "vehicle.camera.delay"},
    {"live.velodyne_model", "vehicle.lidar.model"},
    {"live.velodyne_calibration", "vehicle.lidar.calibration"},
    {"live.imu_delay", "vehicle.imu.delay"},
    {"replay.imu_delay", "vehicle.imu.delay"},
    {"mount.given", "roll, pitch and yaw of [vehicle.imu], each of which says so"},
    {"mount.roll", "vehicle.imu.roll"},
    {"mount.pitch", "vehicle.imu.pitch with the opposite sign"},
    {"mount.yaw", "vehicle.imu.yaw"},
});

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

// Returns the table of a dotted name.
runtime::ConfigTable table_in(runtime::ConfigTable table, std::string_view name) {
  while (!name.empty()) {
    const std::size_t dot = std::min(name.find('.'), name.size());
    table = table.table(name.substr(0, dot));
    name.remove_prefix(std::min(dot + 1, name.size()));
  }
  return table;
}

void read_part(const runtime::ConfigTable& root, const auto& table, auto& values,
               std::set<std::string, std::less<>>& given) {
  const runtime::ConfigTable in_file = table_in(root, table.name);
  for (const auto& parameter : table.parameters) {
    ParameterValue value = parameter.value_in(values);
    read_value(in_file, parameter, value);
    parameter.set(values, value);
    if (in_file.has(parameter.key))
      given.insert(std::string(table.name) + '.' + std::string(parameter.key));
  }
}

void check_part(const runtime::ConfigTable& root, const auto& table, const auto& values) {
  if (const auto problem = problem_of(table, values))
    table_in(root, table.name).fail(problem->key, problem->text);
}

// Makes a path that a text gives start from the text's folder.
void place_path(const runtime::ConfigTable& root, const std::filesystem::path& folder,
                const char* table, const char* key, std::string& path) {
  if (table_in(root, table).has(key) && !path.empty()) path = (folder / path).string();
}

void place_paths(const runtime::ConfigTable& root, const std::filesystem::path& folder,
                 VehicleDescription& vehicle) {
  place_path(root, folder, "vehicle.camera", "calibration", vehicle.camera.calibration);
  place_path(root, folder, "vehicle.lidar", "calibration", vehicle.lidar.calibration);
}

void place_paths(const runtime::ConfigTable& root, const std::filesystem::path& folder,
                 VehicleConfig& config) {
  place_paths(root, folder, config.vehicle);
  place_path(root, folder, "odometry_poses", "file", config.odometry_poses.file);
  place_path(root, folder, "map", "file", config.map.file);
  place_path(root, folder, "map", "rules", config.map.rules);
  place_path(root, folder, "ppp", "heights", config.ppp.heights);
  if (config.ppp.geoid != "none") place_path(root, folder, "ppp", "geoid", config.ppp.geoid);
  if (!root.table("ppp").has("products")) return;
  for (std::string& product : config.ppp.products) product = (folder / product).string();
}

// Reads the file that [vehicle] names, which has the tables of the vehicle alone.
void read_vehicle_file(const runtime::ConfigTable& root, const std::filesystem::path& folder,
                       VehicleConfig& config) {
  std::string name;
  root.table("vehicle").read("file", name);
  if (name.empty()) return;
  const std::filesystem::path file = folder / name;
  const runtime::ConfigDocument document = runtime::ConfigDocument::load(file);
  const runtime::ConfigTable in_file = document.root();
  each_table(
      [&](const auto& table, auto& values) { read_part(in_file, table, values, config.given); },
      config.vehicle);
  document.reject_unknown();
  each_table([&](const auto& table, const auto& values) { check_part(in_file, table, values); },
             config.vehicle);
  place_paths(in_file, file.parent_path(), config.vehicle);
}

// A text of parameters, with the folder from which its paths start.
struct Layer {
  runtime::ConfigDocument document;
  std::filesystem::path folder;
};

// The names are read first, and the keys that they set may then differ from them.
void read_names(const std::vector<Layer>& layers, VehicleConfig& config) {
  const auto set = [&](const char* key, auto set_by_name) {
    const Layer* last = nullptr;
    std::string name;
    for (const Layer& layer : layers) {
      const runtime::ConfigTable root = layer.document.root();
      root.read(key, name);
      if (root.has(key)) last = &layer;
    }
    if (last == nullptr) return;
    try {
      set_by_name(config, name);
    } catch (const std::invalid_argument& e) {
      last->document.root().fail(key, e.what());
    }
  };
  set("configuration", set_configuration);
  set("imu_grade", set_imu_grade);
}

void read_layer(const Layer& layer, VehicleConfig& config) {
  const runtime::ConfigTable root = layer.document.root();
  read_vehicle_file(root, layer.folder, config);
  each_part(config,
            [&](const auto& table, auto& values) { read_part(root, table, values, config.given); });
  for (const ScheduledThread& thread : scheduled_threads()) {
    read(root.table("scheduling"), thread.key, config.scheduling.*thread.scheduling);
  }
  layer.document.reject_unknown(moved_keys);
  each_part(config,
            [&](const auto& table, const auto& values) { check_part(root, table, values); });
  place_paths(root, layer.folder, config);
}

// TABLE.KEY=VALUE is TOML, unless the quotes of a text are left out.
runtime::ConfigDocument parse_setting(const std::string& setting) {
  const std::string name = "--set " + setting;
  const std::size_t equal = setting.find('=');
  if (equal == std::string::npos) {
    throw runtime::ConfigError(name +
                               ": write TABLE.KEY=VALUE, as in --set fusion.gyro_noise=1e-4");
  }
  try {
    return runtime::ConfigDocument::parse(setting, name);
  } catch (const runtime::ConfigError&) {
    const std::size_t text = std::min(setting.find_first_not_of(' ', equal + 1), setting.size());
    return runtime::ConfigDocument::parse(
        setting.substr(0, equal + 1) + '\'' + setting.substr(text) + '\'', name);
  }
}

}  // namespace

VehicleConfig::VehicleConfig() {
  set_configuration(*this, "auto");
}

bool VehicleConfig::is_given(std::string_view table, std::string_view key) const {
  return given.contains(std::string(table) + '.' + std::string(key));
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

VehicleConfig load_vehicle_config(const std::filesystem::path& file,
                                  const std::vector<std::string>& settings,
                                  const std::vector<std::string>& topics) {
  std::vector<Layer> layers;
  if (!file.empty()) layers.push_back({runtime::ConfigDocument::load(file), file.parent_path()});
  for (const std::string& setting : settings) layers.push_back({parse_setting(setting), {}});
  VehicleConfig config;
  read_names(layers, config);
  for (const Layer& layer : layers) read_layer(layer, config);
  if (!layers.empty()) describe_car(config, {});
  config.vehicle_file.clear();  // all of it is in `vehicle`
  config.bag.topics.insert(config.bag.topics.end(), topics.begin(), topics.end());
  return config;
}

ppp::SetupOptions setup_options(const PppConfig& config) {
  return {config.filter, {}, config.broadcast, config.heights, config.geoid};
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
