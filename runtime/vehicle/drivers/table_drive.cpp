#include "runtime/vehicle/drivers/table_drive.h"

#include <memory>
#include <utility>

#include "estimators/fusion/configuration.h"
#include "sensors/replay/table_recording.h"

namespace maploop::vehicle {

Recording open_tables(const std::filesystem::path& folder, const VehicleConfig& config) {
  auto tables = std::make_shared<const sensors::TableRecording>(folder);
  Recording recording;
  recording.first_stamp = tables->first_stamp();
  recording.last_stamp = tables->last_stamp();
  recording.images = tables->fix_count();
  recording.peer_reference = true;
  recording.fixes = [tables] { return tables->gnss(); };
  recording.calibration.rear_axle_distance = sensors::TableRecording::cabin_ahead;
  VehicleConfig car = config;
  describe_car(car, recording.calibration);
  recording.sensors = [tables, car, outages = outages_of(config, recording)](Time) {
    Sensors s;
    s.gnss = tables->gnss();
    if (tables->has_imu() && fusion::configuration(car.configuration).inertial) {
      s.imu = tables->imu(with_outages(tables->gnss(), outages), mount_of(car),
                          car.fusion.rear_axle_distance);
    }
    if (tables->has_reference()) s.reference = tables->reference();
    return s;
  };
  return recording;
}

}  // namespace maploop::vehicle
