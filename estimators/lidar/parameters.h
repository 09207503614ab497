// Everything that can be set in the LiDAR odometry.
#pragma once

namespace maploop::lidar {

struct LidarParameters {
  // --- Crop
  double min_range = 3.0;    // m from the LiDAR; nearer is the vehicle itself or its dirt
  double max_range = 80.0;   // m; further, beams are too far apart to show a surface
  int max_points = 400'000;  // a scan with more is thinned evenly; three turns of an HDL-64E

  // --- Correction of the sensor
  double elevation_correction = 0.0;  // rad, added to every beam's elevation

  // --- Sampling and surfaces
  double sample_voxel = 1.0;   // m; one surface point each, from all its points
  int min_surface_points = 6;  // in a voxel and its 6 neighbours; fewer show no normal
  int max_samples = 32'768;    // voxels of a scan; the rest of its points is left out, and counted

  // --- Local map
  bool scan_to_scan = false;    // compare with the last scan alone, as in the thesis
  double map_voxel = 1.0;       // m
  double map_spacing = 0.25;    // m, closest surface points in it
  double map_radius = 90.0;     // m around the vehicle; what is further is forgotten
  int map_max_voxels = 65'536;  // bound of its memory: 22 MB

  // --- Registration
  double plane_thickness = 1e-3;  // variance across a surface to along it (Segal et al.: epsilon)
  bool constant_motion = true;    // where there is no visual motion; false: seeded by the last pose
  double max_distance = 1.0;      // m between partners at first ...
  double unseeded_distance = 4.0;  // ... where nothing is known of the motion: 40 m/s ...
  double min_distance = 0.5;       // ... shrinking by a third each iteration down to this
  double kernel = 3.0;             // whitened distance at which a pair has lost three quarters
  double point_sigma = 0.05;       // m across a surface: range noise, roughness
  int max_iterations = 10;         // searches for partners
  int steps = 3;                   // at most with the same partners
  double translation_step = 1e-3;  // m and
  double rotation_step = 1e-4;     // rad: an iteration that moves less is the last one
  int min_points = 300;            // samples with a normal; fewer: too_few_features
  double min_overlap = 0.4;        // share of them with a partner; less: too_few_inliers

  // --- Degeneracy: information a point on a direction, rotations as metres at the mean range.
  double min_information = 0.003;

  // --- Covariance
  // Factor on the covariance of independent points. Odometries from disjoint halves of the points
  // differ over a second by what 0.05 predicts; the rest is for what both halves share.
  double correlated_points = 1.0;

  // --- Visual motion, given the LiDAR's length (disparity_correction.h)
  bool correct_disparities = true;
  // px / sqrt(s): the error depends on the place in the image, so what a constant has to stand for
  // changes with the scene, by 0.4 px in 10 s of the recorded drive.
  double disparity_drift = 0.1;
  double min_disparity_sigma = 0.03;  // px; 0.1 % of the way, what the scans' own scale is good for

  // --- Agreement with the seed, of one interval of 0.1 s
  double max_disagreement = 0.5;              // m
  double max_disagreement_rotation = 0.0175;  // rad (1 deg)
  int restart_after = 5;  // refused scans in a row; then the map is the one at fault

  // --- Plausibility of a road vehicle
  double max_speed = 70.0;       // m/s
  double max_yaw_rate = 1.5708;  // rad/s (90 deg/s)
  double max_gap = 1.0;          // s; an older scan is not compared with any more
  int max_stale_scans = 10;      // in a row with old stamps after which time starts anew
};

}  // namespace maploop::lidar
