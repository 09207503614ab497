// Everything that can be set in the LiDAR odometry; parameter_table.cpp describes each parameter.
#pragma once

namespace maploop::lidar {

// Holds the parameters of LidarOdometry, whose constructor checks them.
struct LidarParameters {
  // --- Crop
  double min_range = 3.0;    // m, nearer points are left out
  double max_range = 80.0;   // m
  int max_points = 400'000;  // of a scan; more are thinned evenly

  // --- Correction of the sensor
  double elevation_correction = 0.0;  // rad, added to the elevation of every beam

  // --- Sampling and surfaces
  double sample_voxel = 1.0;     // m, edge of the voxels that each give one surface point
  int min_surface_points = 6;    // of a voxel and its 6 neighbours, for a normal
  double min_beam_spread = 0.1;  // m
  int max_samples = 32'768;      // voxels of a scan; points in others are left out

  // --- Local map
  bool scan_to_scan = false;    // compare with the previous scan alone, not the map
  double map_voxel = 1.0;       // m
  double map_spacing = 0.25;    // m
  double map_radius = 90.0;     // m
  int map_max_voxels = 65'536;  // at most, 22 MB of memory

  // --- Registration
  double plane_thickness = 1e-3;   // variance across a surface to that along it
  bool constant_motion = true;     // without a visual motion, seed by the last motion
  double max_distance = 1.0;       // m
  double unseeded_distance = 4.0;  // m
  double min_distance = 0.5;       // m
  double kernel = 3.0;             // whitened distance at which a pair loses 3/4 of its weight
  double point_sigma = 0.05;       // m
  int max_iterations = 10;         // searches for partners at most
  int steps = 3;                   // of the optimization at most with the same partners
  double translation_step = 1e-3;  // m
  double rotation_step = 1e-4;     // rad
  int min_points = 300;            // samples with a normal; fewer make it too_few_features
  double min_overlap = 0.4;        // share of samples with a partner, else too_few_inliers

  // --- Degeneracy
  double min_information = 0.003;  // per point; with less a direction is undetermined

  // --- Covariance
  double correlated_points = 1.0;  // factor on the covariance of independent points

  // --- Visual motion, given the LiDAR's length (disparity_correction.h)
  bool correct_disparities = true;    // correct visual motions by the LiDAR's length
  double disparity_drift = 0.1;       // px/sqrt(s)
  double min_disparity_sigma = 0.03;  // px

  // --- Agreement with the seed
  double max_disagreement = 0.5;              // m in 0.1 s; a motion that differs more is refused
  double max_disagreement_rotation = 0.0175;  // rad (1 deg)
  int restart_after = 5;                      // refused scans in a row; then the map starts again

  // --- Plausibility of a road vehicle
  double max_speed = 70.0;       // m/s, a faster motion is refused
  double max_yaw_rate = 1.5708;  // rad/s (90 deg/s)
  double max_gap = 1.0;          // s
  int max_stale_scans = 10;      // with old stamps in a row; then time starts again
};

}  // namespace maploop::lidar
