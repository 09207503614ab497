// Everything that can be set in the LiDAR odometry; parameter_table.cpp describes each parameter.
#pragma once

namespace maploop::lidar {

struct LidarParameters {
  // --- Crop
  double min_range = 3.0;   // m
  double max_range = 80.0;  // m
  int max_points = 400'000;

  // --- Correction of the sensor
  double elevation_correction = 0.0;  // rad

  // --- Sampling and surfaces
  double sample_voxel = 1.0;  // m
  int min_surface_points = 6;
  double min_beam_spread = 0.1;  // m
  int max_samples = 32'768;

  // --- Local map
  bool scan_to_scan = false;
  double map_voxel = 1.0;     // m
  double map_spacing = 0.25;  // m
  double map_radius = 90.0;   // m
  int map_max_voxels = 65'536;

  // --- Registration
  double plane_thickness = 1e-3;
  bool constant_motion = true;
  double max_distance = 1.0;       // m
  double unseeded_distance = 4.0;  // m
  double min_distance = 0.5;       // m
  double kernel = 3.0;
  double point_sigma = 0.05;  // m
  int max_iterations = 10;
  int steps = 3;
  double translation_step = 1e-3;  // m
  double rotation_step = 1e-4;     // rad
  int min_points = 300;
  double min_overlap = 0.4;

  // --- Degeneracy
  double min_information = 0.003;

  // --- Covariance
  double correlated_points = 1.0;

  // --- Visual motion, given the LiDAR's length (disparity_correction.h)
  bool correct_disparities = true;
  double disparity_drift = 0.1;       // px/sqrt(s)
  double min_disparity_sigma = 0.03;  // px

  // --- Agreement with the seed
  double max_disagreement = 0.5;              // m
  double max_disagreement_rotation = 0.0175;  // rad (1 deg)
  int restart_after = 5;

  // --- Plausibility of a road vehicle
  double max_speed = 70.0;       // m/s
  double max_yaw_rate = 1.5708;  // rad/s (90 deg/s)
  double max_gap = 1.0;          // s
  int max_stale_scans = 10;
};

}  // namespace maploop::lidar
