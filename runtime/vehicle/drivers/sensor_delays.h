// Takes the delays of the vehicle's sensors off the stamps of a recording.
#pragma once

#include <memory>
#include <vector>

#include "msgs/gnss.h"
#include "msgs/time.h"
#include "runtime/vehicle/config/vehicle_config.h"
#include "runtime/vehicle/drivers/gnss_outage.h"
#include "runtime/vehicle/graph/sensors.h"

namespace maploop::vehicle {

// These are the times from a measurement to its stamp.
struct SensorDelays {
  Duration camera{}, lidar{}, imu{}, antenna{};
};

// Returns those of [vehicle.camera] and the other sensors.
SensorDelays delays_of(const VehicleConfig& config);

// The same for the rows of an OXTS unit, whose reader takes off the delay of the unit by itself:
// its velocities are as late as its rates, and its positions are not.
SensorDelays delays_of_oxts(const VehicleConfig& config);

// Moves the stamps of all sensors, and of odometry in place of images. When a sample is available
// does not change. A receiver's observations have the time of GNSS, and no delay.
void take_delays(Sensors& sensors, const SensorDelays& delays);

// Returns the fixes that find how the inertial unit is mounted, without those of the outages. Their
// stamps are those that the unit would give them.
std::unique_ptr<sensors::Source<GnssFix>> on_the_units_clock(
    std::unique_ptr<sensors::Source<GnssFix>> fixes, const std::vector<GnssOutage>& outages,
    const SensorDelays& delays);

}  // namespace maploop::vehicle
