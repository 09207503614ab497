// The sensors and the reference that the rows of an OXTS stand for.
#pragma once

#include <memory>

#include "msgs/gnss.h"
#include "msgs/imu.h"
#include "msgs/reference.h"
#include "sensors/replay/gnss_aid.h"
#include "sensors/replay/oxts.h"
#include "sensors/replay/wheel_odometer.h"
#include "sensors/source.h"

namespace maploop::sensors {

// The unit's position and attitude belong to the stamp of their row, its rates, velocities and
// accelerations to a moment `delay` before it (measured on KITTI: about 60 ms). All are available
// at the stamp of the row. Every source reports every row that it could not use.

// ImuSample: stamp = row's - delay, sequence = row.
std::unique_ptr<Source<ImuSample>> make_imu_source(std::shared_ptr<const OxtsRows> rows,
                                                   Duration delay);

// GnssFix: stamp = row's, velocity_stamp = row's - delay, sequence = GnssAid's period.
std::unique_ptr<Source<GnssFix>> make_gnss_source(std::shared_ptr<const OxtsRows> rows,
                                                  Duration delay,
                                                  const GnssAidParameters& parameters);

// WheelSpeed: stamp = row's - delay, sequence = row.
std::unique_ptr<Source<WheelSpeed>> make_wheel_source(std::shared_ptr<const OxtsRows> rows,
                                                      Duration delay,
                                                      const WheelOdometerParameters& parameters);

// ReferencePose: stamp = row's, velocity_stamp = row's - delay, sequence = row.
std::unique_ptr<Source<ReferencePose>> make_reference_source(std::shared_ptr<const OxtsRows> rows,
                                                             Duration delay);

}  // namespace maploop::sensors
