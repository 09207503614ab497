// Every parameter by name: what the configuration file can set. The TOML key is the member's name.
#pragma once

#include "estimators/fusion/parameter_fields.h"
#include "estimators/lidar/parameter_fields.h"
#include "estimators/stereo/parameter_fields.h"
#include "mapmatch/parameter_fields.h"
#include "runtime/vehicle/vehicle_config.h"

namespace maploop::vehicle {

// Calls table(name) at the begin of each table, and field(key, member) for each of its keys. Config
// is VehicleConfig, const or not.
template <class Config, class Table, class Field>
void visit(Config& config, Table&& table, Field&& field) {
  field("lcm_url", config.lcm_url);
  field("configuration", config.configuration);
  field("imu_grade", config.imu_grade);
  field("odometry", config.odometry);

  table("scheduling");
  {
    auto& p = config.scheduling;
    field("camera", p.camera);
    field("velodyne", p.velodyne);
    field("imu", p.imu);
    field("gnss", p.gnss);
    field("wheel", p.wheel);
    field("reference", p.reference);
    field("odometry", p.odometry);
    field("stereo", p.stereo);
    field("lidar", p.lidar);
    field("ppp", p.ppp);
    field("fusion", p.fusion);
    field("mapmatch", p.mapmatch);
    field("publisher", p.publisher);
    field("health", p.health);
    field("snapshot", p.snapshot);
    field("preview", p.preview);
  }

  table("memory");
  {
    auto& p = config.memory;
    field("lock_memory", p.lock_memory);
    field("heap_mb", p.heap_mb);
    field("malloc_arenas", p.malloc_arenas);
  }

  table("trace");
  field("events_per_thread", config.trace.events_per_thread);

  table("preview");
  {
    auto& p = config.preview;
    field("rate", p.rate);
    field("width", p.width);
    field("quality", p.quality);
    field("points", p.points);
  }

  table("camera");
  field("calibration", config.camera.calibration);

  table("replay");
  {
    auto& p = config.replay;
    field("imu_delay", p.imu_delay);
    field("camera_readout", p.camera_readout);
    field("max_pair_skew", p.max_pair_skew);
    field("max_turn", p.max_turn);
  }

  table("odometry_poses");
  {
    auto& p = config.odometry_poses;
    field("file", p.file);
    field("speed_sigma", p.speed_sigma);
    field("rotation_sigma", p.rotation_sigma);
  }

  table("live");
  {
    auto& p = config.live;
    field("calibration", p.calibration);
    field("camera_left", p.camera_left);
    field("camera_right", p.camera_right);
    field("camera_delay", p.camera_delay);
    field("velodyne", p.velodyne);
    field("velodyne_position", p.velodyne_position);
    field("velodyne_model", p.velodyne_model);
    field("velodyne_calibration", p.velodyne_calibration);
    field("imu", p.imu);
    field("imu_protocol", p.imu_protocol);
    field("imu_delay", p.imu_delay);
    field("gnss", p.gnss);
    field("gnss_protocol", p.gnss_protocol);
    field("gnss_latency", p.gnss_latency);
    field("gnss_frequencies", p.gnss_frequencies);
    field("gnss_antenna", p.gnss_antenna);
    field("corrections", p.corrections);
  }

  table("gnss");
  {
    auto& p = config.gnss;
    field("rate", p.rate);
    field("white_position", p.white_position);
    field("markov_position", p.markov_position);
    field("markov_time", p.markov_time);
    field("white_velocity", p.white_velocity);
    field("errors", p.errors);
    field("seed", p.seed);
    field("outage", config.gnss_outage);
  }

  table("wheel");
  {
    auto& p = config.wheel;
    field("scale_error", p.scale_error);
    field("white_speed", p.white_speed);
    field("slip", p.slip);
    field("ice_share", p.ice_share);
    field("errors", p.errors);
    field("seed", p.seed);
  }

  table("imu");
  field("noise", config.imu_noise);
  field("errors", config.imu_errors);
  field("seed", config.imu_seed);

  table("stereo");
  fields(config.stereo, field);

  table("lidar");
  fields(config.lidar, field);

  table("ppp");
  {
    auto& p = config.ppp;
    field("observations", p.observations);
    field("products", p.products);
    field("broadcast", p.broadcast);
    field("latency", p.latency);
    field("integrity_risk", p.integrity_risk);
    field("systems", p.filter.systems);
    fields(p.filter, field);
  }

  table("map");
  field("file", config.map.file);
  field("mode", config.map.mode);
  field("rules", config.map.rules);

  table("mapmatch");
  fields(config.mapmatch, field);

  table("feedback");
  fields(config.feedback, field);

  table("guard");
  fields(config.guard, field);

  table("fusion");
  fields(config.fusion, field);
}

}  // namespace maploop::vehicle
