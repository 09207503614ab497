// Reads maploop.tables.toml: which columns of which tables are what a sensor measured.
#include <array>
#include <numbers>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "msgs/named_enum.h"
#include "ppp/gps_time.h"
#include "runtime/core/config.h"
#include "runtime/vehicle/drivers/table_drive.h"
#include "sensors/folder/number_table.h"
#include "sensors/folder/table_recording.h"

namespace maploop::vehicle {
namespace {

namespace fs = std::filesystem;
using runtime::ConfigTable;
using sensors::Columns;

struct Unit {
  std::string_view name;
  double in_si;
};

constexpr double degree = std::numbers::pi / 180.0;
constexpr std::array rate_units{Unit{"rad/s", 1.0}, Unit{"deg/s", degree}};
constexpr std::array force_units{Unit{"m/s2", 1.0}, Unit{"g", 9.80665}, Unit{"mg", 9.80665e-3}};
constexpr std::array speed_units{Unit{"m/s", 1.0}, Unit{"km/h", 1.0 / 3.6}};
constexpr std::array angle_units{Unit{"deg", 1.0}, Unit{"rad", 1.0 / degree}};

Time utc_of_gps(Time gps) {
  return ppp::to_utc(ppp::GpsTime(gps - Time(ppp::gps_epoch_day)));
}

template <std::size_t n>
double read_unit(const ConfigTable& table, const std::string& key,
                 const std::array<Unit, n>& units) {
  std::array<std::string_view, n> names;
  for (std::size_t i = 0; i < n; ++i) names[i] = units[i].name;
  std::string name(names[0]);
  table.read_one_of(key, name, names);
  for (const Unit& unit : units)
    if (unit.name == name) return unit.in_si;
  return 1.0;
}

template <class Enum>
void read_enum(const ConfigTable& table, std::string_view key, Enum& value) {
  std::string name(to_string(value));
  table.read_one_of(key, name, names_of(value));
  value = *value_named<Enum>(name);
}

// Reads the names of `count` columns.
void read_columns(const ConfigTable& table, std::string_view key, std::size_t count,
                  Columns& columns, bool needed = false) {
  table.read(key, columns.names);
  if (needed && columns.names.empty()) table.fail(key, "is missing; it names the columns");
  if (!columns.names.empty() && columns.names.size() != count)
    table.fail(key, "must name " + std::to_string(count) + " columns");
}

// Returns whether the table is there.
bool read_file(const ConfigTable& table, const fs::path& folder, sensors::TableFile& file) {
  std::string name;
  table.read("file", name);
  if (name.empty()) return false;
  file.file = folder / name;
  table.read("columns", file.columns);
  file.time.resize(1);
  table.read("time", file.time[0]);
  read_enum(table, "time_unit", file.time_unit);
  table.read("gps_time", file.gps_time);
  if (file.time_unit == sensors::TimeUnit::gps_week) {
    std::string week = "week";
    table.read("week", week);
    file.time.insert(file.time.begin(), week);
  }
  return true;
}

// Fills what the heading of RTKLIB's file says.
void describe_pos(const fs::path& file, sensors::GnssTable& gnss) {
  const sensors::NumberTable table(file);
  gnss.file = file;
  gnss.gps_time = table.has("GPST");
  gnss.time = {gnss.gps_time ? "GPST" : "UTC"};
  const bool geodetic = table.has("latitude");
  gnss.form = geodetic ? sensors::PositionForm::geodetic : sensors::PositionForm::ecef;
  gnss.position.names = geodetic ? std::vector<std::string>{"latitude", "longitude", "height"}
                                 : std::vector<std::string>{"x-ecef", "y-ecef", "z-ecef"};
  gnss.position_sigma.names = geodetic ? std::vector<std::string>{"sdn", "sde", "sdu"}
                                       : std::vector<std::string>{"sdx", "sdy", "sdz"};
  if (geodetic && table.has("vn")) {
    gnss.velocity.names = {"ve", "vn", "vu"};
    gnss.velocity_axes = sensors::VelocityAxes::enu;
  }
  gnss.quality.names = {"Q"};
}

void read_position(const ConfigTable& table, auto& to) {
  read_enum(table, "position_form", to.form);
  read_columns(table, "position", 3, to.position, true);
  to.position.unit = read_unit(table, "position_unit", angle_units);
  if (to.form != sensors::PositionForm::geodetic) to.position.unit = 1.0;
  read_columns(table, "velocity", 3, to.velocity);
  to.velocity.unit = read_unit(table, "velocity_unit", speed_units);
  read_enum(table, "velocity_axes", to.velocity_axes);
}

void read_gnss(const ConfigTable& table, const fs::path& folder, sensors::GnssTable& gnss) {
  if (!read_file(table, folder, gnss)) return;
  if (sensors::is_pos_file(gnss.file)) return describe_pos(gnss.file, gnss);
  read_position(table, gnss);
  read_columns(table, "position_sigma", 3, gnss.position_sigma);
  read_columns(table, "velocity_sigma", 3, gnss.velocity_sigma);
  table.read("position_sigma_m", gnss.default_position_sigma);
  table.read("velocity_sigma_mps", gnss.default_velocity_sigma);
  for (const auto& [key, sigma] : {std::pair("position_sigma_m", gnss.default_position_sigma),
                                   std::pair("velocity_sigma_mps", gnss.default_velocity_sigma)})
    if (!(sigma > 0.0 && sigma < 1e3)) table.fail(key, "must be above 0 and below 1000");
  std::string quality;
  table.read("quality", quality);
  if (!quality.empty()) gnss.quality.names = {quality};
}

void read_imu(const ConfigTable& table, const fs::path& folder, sensors::ImuTable& imu) {
  if (!read_file(table, folder, imu)) return;
  read_columns(table, "gyro", 3, imu.gyro, true);
  imu.gyro.unit = read_unit(table, "gyro_unit", rate_units);
  read_columns(table, "accelerometer", 3, imu.accelerometer, true);
  imu.accelerometer.unit = read_unit(table, "accelerometer_unit", force_units);
}

void read_wheel(const ConfigTable& table, const fs::path& folder, sensors::WheelTable& wheel) {
  if (!read_file(table, folder, wheel)) return;
  std::string speed;
  table.read("speed", speed);
  if (speed.empty()) table.fail("speed", "is missing; it names a column");
  wheel.speed = {{speed}, read_unit(table, "speed_unit", speed_units)};
  table.read("sigma_mps", wheel.sigma);
  if (!(wheel.sigma > 0.0 && wheel.sigma < 1e3))
    table.fail("sigma_mps", "must be above 0 and below 1000");
}

void read_reference(const ConfigTable& table, const fs::path& folder,
                    sensors::ReferenceTable& reference) {
  if (!read_file(table, folder, reference)) return;
  read_position(table, reference);
  read_columns(table, "attitude", 3, reference.attitude);
  reference.attitude.unit = read_unit(table, "attitude_unit", angle_units);
  read_columns(table, "quaternion", 4, reference.quaternion, !reference.attitude.given());
  table.read("accuracy_m", reference.accuracy);
  if (!(reference.accuracy > 0.0 && reference.accuracy < 1e3))
    table.fail("accuracy_m", "must be above 0 and below 1000");
  reference.peer = false;
}

}  // namespace

sensors::TableMapping read_table_mapping(const fs::path& file) {
  const runtime::ConfigDocument document = runtime::ConfigDocument::load(file);
  const ConfigTable root = document.root();
  const fs::path folder = file.parent_path();
  sensors::TableMapping mapping;
  mapping.utc_of_gps = utc_of_gps;
  read_imu(root.table("imu"), folder, mapping.imu);
  read_gnss(root.table("gnss"), folder, mapping.gnss);
  read_wheel(root.table("wheel"), folder, mapping.wheel);
  read_reference(root.table("reference"), folder, mapping.reference);
  document.reject_unknown();
  return mapping;
}

std::optional<sensors::TableMapping> find_table_mapping(const fs::path& path) {
  std::error_code ignored;
  if (const fs::path file = path / "maploop.tables.toml"; fs::is_regular_file(file, ignored))
    return read_table_mapping(file);
  if (sensors::is_pos_file(path) && fs::is_regular_file(path, ignored)) {
    sensors::TableMapping mapping;
    mapping.utc_of_gps = utc_of_gps;
    describe_pos(path, mapping.gnss);
    return mapping;
  }
  if (sensors::TableRecording::is_named(path)) return sensors::plain_tables(path);
  return std::nullopt;
}

}  // namespace maploop::vehicle
