#include "runtime/vehicle/drivers/bag_drive.h"

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "runtime/vehicle/drivers/gnss_drive.h"
#include "sensors/bag/bag_recording.h"

namespace maploop::vehicle {

using sensors::BagSensor;

FusedSensors fused_sensors_of_bag(const std::filesystem::path& path,
                                  const sensors::BagSummary& contents,
                                  const sensors::BagParameters& parameters) {
  const sensors::TopicChoice choice = sensors::choose_topics(path, contents, parameters.topics);
  const auto has = [&](BagSensor sensor) { return choice.find(sensor) != nullptr; };
  return {has(BagSensor::camera_left) || has(BagSensor::lidar) || has(BagSensor::wheel),
          has(BagSensor::imu)};
}

namespace {

// Returns nullptr, with a note, if there are no observations, or none that can be used.
std::shared_ptr<const GnssDrive> observations_of(const sensors::BagRecording& bag,
                                                 const std::filesystem::path& path,
                                                 const VehicleConfig& config,
                                                 std::vector<std::string>& notes) {
  if (!bag.has(BagSensor::gnss_raw) || !config.ppp.observations) return nullptr;
  try {
    return std::make_shared<const GnssDrive>(path, bag.observations(notes), config);
  } catch (const std::runtime_error& e) {
    if (!bag.has(BagSensor::gnss)) throw;
    notes.push_back(std::string("The receiver's observations are not used, but its fixes: ") +
                    e.what() + ".");
    return nullptr;
  }
}

}  // namespace

Recording open_bag(const std::filesystem::path& path, const VehicleConfig& config,
                   const KnownContents& contents) {
  const sensors::BagVehicle vehicle{raw_cameras(config), config.vehicle.lidar.calibration};
  const sensors::BagLimits limits{config.replay.camera_readout, config.replay.max_pair_skew,
                                  config.replay.max_turn};
  const KnownContents known =
      contents != nullptr ? contents
                          : std::make_shared<const sensors::BagSummary>(sensors::summarize(path));
  const auto bag =
      std::make_shared<sensors::BagRecording>(path, *known, config.bag, vehicle, limits);
  Recording recording;
  recording.calibration = bag->calibration();
  recording.calibration.fused = fused_sensors_of_bag(path, *known, config.bag);
  recording.first_stamp = bag->first_stamp();
  recording.last_stamp = bag->last_stamp();
  recording.images = bag->frame_count();
  recording.notes = bag->notes();
  recording.delays = delays_of(config);
  const auto epochs = observations_of(*bag, path, config, recording.notes);
  VehicleConfig car = config;
  describe_car(car, recording.calibration);
  recording.sensors = [bag, epochs, car, delays = recording.delays,
                       outages = outages_of(config, recording)](Time passed) {
    Sensors s;
    if (bag->has(BagSensor::camera_left)) s.camera = bag->camera(passed);
    if (bag->has(BagSensor::lidar)) s.velodyne = bag->lidar(passed);
    const bool fixes = bag->has(BagSensor::gnss);
    if (fixes) s.gnss = bag->gnss();
    if (bag->has(BagSensor::imu)) {
      s.imu = bag->imu(fixes ? on_the_units_clock(bag->gnss(), outages, delays) : nullptr,
                       mount_of(car), car.fusion.rear_axle_distance);
    }
    if (bag->has(BagSensor::wheel)) s.wheel = bag->wheel();
    if (epochs != nullptr) use_observations(s, epochs);
    return s;
  };
  return recording;
}

}  // namespace maploop::vehicle
