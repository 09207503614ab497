// Every parameter by name: what a configuration file sets, and what an archive must agree with.
#pragma once

#include <concepts>
#include <type_traits>

#include "estimators/lidar/parameters.h"

namespace maploop::lidar {

// Calls f(name, member) for each; Parameters is LidarParameters, const or not.
template <class Parameters, class F>
requires std::same_as<std::remove_const_t<Parameters>, LidarParameters>
void fields(Parameters& p, F&& f) {
  f("min_range", p.min_range);
  f("max_range", p.max_range);
  f("max_points", p.max_points);
  f("elevation_correction", p.elevation_correction);
  f("sample_voxel", p.sample_voxel);
  f("min_surface_points", p.min_surface_points);
  f("max_samples", p.max_samples);
  f("scan_to_scan", p.scan_to_scan);
  f("map_voxel", p.map_voxel);
  f("map_spacing", p.map_spacing);
  f("map_radius", p.map_radius);
  f("map_max_voxels", p.map_max_voxels);
  f("plane_thickness", p.plane_thickness);
  f("constant_motion", p.constant_motion);
  f("max_distance", p.max_distance);
  f("unseeded_distance", p.unseeded_distance);
  f("min_distance", p.min_distance);
  f("kernel", p.kernel);
  f("point_sigma", p.point_sigma);
  f("max_iterations", p.max_iterations);
  f("steps", p.steps);
  f("translation_step", p.translation_step);
  f("rotation_step", p.rotation_step);
  f("min_points", p.min_points);
  f("min_overlap", p.min_overlap);
  f("min_information", p.min_information);
  f("correlated_points", p.correlated_points);
  f("correct_disparities", p.correct_disparities);
  f("disparity_drift", p.disparity_drift);
  f("min_disparity_sigma", p.min_disparity_sigma);
  f("max_disagreement", p.max_disagreement);
  f("max_disagreement_rotation", p.max_disagreement_rotation);
  f("restart_after", p.restart_after);
  f("max_speed", p.max_speed);
  f("max_yaw_rate", p.max_yaw_rate);
  f("max_gap", p.max_gap);
  f("max_stale_scans", p.max_stale_scans);
}

}  // namespace maploop::lidar
