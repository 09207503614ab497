// This file makes sensors and the reference from the rows of an OXTS unit.
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

// The unit's position and attitude are valid at the stamp of their row; its rates, velocities and
// accelerations are valid `delay` before it (measured on KITTI: about 60 ms). All are available at
// the stamp of the row. Every source reports every row that it could not use.

// ImuSample has stamp = row's - delay, sequence = row.
std::unique_ptr<Source<ImuSample>> make_imu_source(std::shared_ptr<const OxtsRows> rows,
                                                   Duration delay);

// GnssFix has stamp = row's, velocity_stamp = row's - delay, sequence = GnssAid's period.
std::unique_ptr<Source<GnssFix>> make_gnss_source(std::shared_ptr<const OxtsRows> rows,
                                                  Duration delay,
                                                  const GnssAidParameters& parameters);

// WheelSpeed has stamp = row's - delay, sequence = row.
std::unique_ptr<Source<WheelSpeed>> make_wheel_source(std::shared_ptr<const OxtsRows> rows,
                                                      Duration delay,
                                                      const WheelOdometerParameters& parameters);

// ReferencePose has stamp = row's, velocity_stamp = row's - delay, sequence = row.
std::unique_ptr<Source<ReferencePose>> make_reference_source(std::shared_ptr<const OxtsRows> rows,
                                                             Duration delay);

}  // namespace maploop::sensors
