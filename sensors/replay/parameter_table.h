// These tables describe what can be set about replayed sensors: [replay], [odometry_poses], [gnss]
// and [wheel] of the configuration.
#pragma once

#include "msgs/parameter.h"
#include "sensors/replay/gnss_aid.h"
#include "sensors/replay/kitti_drive.h"
#include "sensors/replay/pose_odometry.h"
#include "sensors/replay/wheel_odometer.h"

namespace maploop::sensors {

ParameterTable<KittiDriveParameters> parameter_table(const KittiDriveParameters&);
ParameterTable<PoseOdometryParameters> parameter_table(const PoseOdometryParameters&);
ParameterTable<GnssAidParameters> parameter_table(const GnssAidParameters&);
ParameterTable<WheelOdometerParameters> parameter_table(const WheelOdometerParameters&);

}  // namespace maploop::sensors
