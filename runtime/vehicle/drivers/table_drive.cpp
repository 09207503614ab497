#include "runtime/vehicle/drivers/table_drive.h"

#include <memory>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "estimators/fusion/configuration.h"
#include "sensors/folder/image_lists.h"
#include "sensors/folder/number_table.h"
#include "sensors/folder/table_recording.h"

namespace maploop::vehicle {

Recording open_tables(const std::filesystem::path& folder, const VehicleConfig& config) {
  const auto mapping = find_table_mapping(folder);
  if (!mapping || !(mapping->gnss.given() || mapping->wheel.given())) {
    throw std::runtime_error("'" + folder.string() +
                             "' has no gnss.csv or gnss.csv.gz, and no other table of fixes: a "
                             "drive needs the fixes of a GNSS receiver to have a position "
                             "(sensors/FORMATS.md)");
  }
  auto tables = std::make_shared<const sensors::TableRecording>(*mapping);
  Recording recording;
  recording.first_stamp = tables->first_stamp();
  recording.last_stamp = tables->last_stamp();
  recording.images = tables->fix_count();
  recording.calibration.peer_reference = mapping->reference.peer;
  recording.calibration.fused = fused_sensors_of(*mapping);
  if (tables->has_gnss()) recording.fixes = [tables] { return tables->gnss(); };
  recording.calibration.rear_axle_distance = sensors::TableRecording::cabin_ahead;
  recording.delays = delays_of(config);
  VehicleConfig car = config;
  describe_car(car, recording.calibration);
  recording.sensors = [tables, car, delays = recording.delays,
                       outages = outages_of(config, recording)](Time) {
    Sensors s;
    s.gnss = tables->gnss();
    if (tables->has_imu() && fusion::configuration(car.configuration).inertial) {
      s.imu = tables->imu(on_the_units_clock(tables->gnss(), outages, delays), mount_of(car),
                          car.fusion.rear_axle_distance);
    }
    s.wheel = tables->wheel();
    s.reference = tables->reference();
    return s;
  };
  return recording;
}

FusedSensors fused_sensors_of(const sensors::TableMapping& mapping) {
  return {false, mapping.imu.given(), mapping.wheel.given()};
}

bool is_table_drive(const std::filesystem::path& path) {
  std::error_code ignored;
  const bool tables = sensors::TableRecording::is_named(path) ||
                      std::filesystem::exists(path / "maploop.tables.toml", ignored);
  if (tables) return !sensors::has_images(path) && !sensors::find_scans(path);
  return std::filesystem::is_regular_file(path, ignored) && sensors::is_pos_file(path);
}

}  // namespace maploop::vehicle
