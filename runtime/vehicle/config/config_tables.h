// This file describes the vehicle's own parameters, and lists every table of the configuration file
// with the part of a VehicleConfig that it describes. (scheduling_config.h has [scheduling].)
#pragma once

#include "estimators/fusion/parameter_table.h"
#include "estimators/lidar/parameter_table.h"
#include "estimators/stereo/parameter_table.h"
#include "mapmatch/parameter_table.h"
#include "ppp/filter/parameter_table.h"
#include "runtime/core/parameter_table.h"
#include "runtime/vehicle/config/vehicle_config.h"
#include "sensors/bag/bag_parameters.h"
#include "sensors/replay/parameter_table.h"

namespace maploop::vehicle {

ParameterTable<VehicleConfig> top_level_table();     // of keys outside any table
ParameterTable<VehicleConfig> gnss_outage_table();   // of a key of [gnss]
ParameterTable<VehicleConfig> vehicle_file_table();  // of a key of [vehicle]
ParameterTable<VehicleConfig> imu_table();           // [imu]
ParameterTable<PreviewParameters> parameter_table(const PreviewParameters&);
ParameterTable<OverloadParameters> parameter_table(const OverloadParameters&);
ParameterTable<LiveParameters> parameter_table(const LiveParameters&);
ParameterTable<PppConfig> parameter_table(const PppConfig&);
ParameterTable<MapParameters> parameter_table(const MapParameters&);

// Calls part(table, values) for each struct of the configuration, in the order of the file. Structs
// one after the other whose tables have the same name share a table of the file. Config is
// VehicleConfig, const or not.
template <class Config, class Part>
void each_part(Config& config, Part&& part) {
  const auto described = [&](auto&... values) { (part(parameter_table(values), values), ...); };
  part(top_level_table(), config);
  described(config.memory, config.trace, config.preview, config.overload);
  part(vehicle_file_table(), config);
  each_table(part, config.vehicle);
  described(config.replay, config.bag, config.odometry_poses, config.live, config.gnss);
  part(gnss_outage_table(), config);
  described(config.wheel);
  part(imu_table(), config);
  described(config.stereo, config.lidar, config.ppp, config.ppp.filter, config.ppp.filter.ground,
            config.map, config.mapmatch, config.feedback, config.guard, config.protection,
            config.fusion);
}

}  // namespace maploop::vehicle
