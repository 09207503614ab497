// Every parameter by name: what the configuration file can set. The TOML key is the member's name.
#pragma once

#include "estimators/fusion/parameter_fields.h"
#include "estimators/stereo/parameter_fields.h"
#include "runtime/vehicle/vehicle_config.h"

namespace maploop::vehicle {

// Calls table(name) at the begin of each table, and field(key, member) for each of its keys. Config
// is VehicleConfig, const or not.
template <class Config, class Table, class Field>
void visit(Config& config, Table&& table, Field&& field) {
  field("lcm_url", config.lcm_url);

  table("scheduling");
  {
    auto& p = config.scheduling;
    field("sensor_priority", p.sensor_priority);
    field("fusion_priority", p.fusion_priority);
    field("stereo_priority", p.stereo_priority);
  }

  table("replay");
  {
    auto& p = config.replay;
    field("imu_delay", p.imu_delay);
    field("camera_readout", p.camera_readout);
    field("max_pair_skew", p.max_pair_skew);
    field("max_turn", p.max_turn);
  }

  table("gnss");
  {
    auto& p = config.gnss;
    field("rate", p.rate);
    field("white_position", p.white_position);
    field("markov_position", p.markov_position);
    field("markov_time", p.markov_time);
    field("white_velocity", p.white_velocity);
    field("seed", p.seed);
  }

  table("stereo");
  fields(config.stereo, field);

  table("fusion");
  fields(config.fusion, field);
}

}  // namespace maploop::vehicle
