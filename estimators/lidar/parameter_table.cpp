#include "estimators/lidar/parameter_table.h"

namespace maploop::lidar {

ParameterTable<LidarParameters> parameter_table(const LidarParameters&) {
  using enum Audience;
  using P = LidarParameters;
  constexpr int many = 1'000'000;
  constexpr DataChoice correlated_points_choice{
      "KITTI drive 0013", "odometries from disjoint halves of the points; no truth",
      "normalized errors of LiDAR odometry on 0013"};
  constexpr DataChoice min_beam_spread_choice{
      "KITTI drive 0013, whole, with a quarter of its beams and with what lies ahead; simulated "
      "cars and towns 1 to 3",
      "0.05, 0.1, 0.2 and 0.3 m; with 0.2 m or more a tunnel is recognized less often",
      "LiDAR odometry on 0013"};
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"min_range", &P::min_range, 0.0, 1000.0, "m", usual,
       "Nearer points are left out: they show the vehicle itself, or dirt on the scanner."},
      {"max_range", &P::max_range, 0.0, 1000.0, "m", usual,
       "Farther points are left out: there the beams are too far apart to show a surface."},
      {"max_points", &P::max_points, 1000, 10'000'000, "points", usual,
       "A scan with more points is thinned evenly. The default is three turns of an HDL-64E."},
      {"elevation_correction", &P::elevation_correction, -0.1, 0.1, "rad", usual,
       "Angle added to the elevation of every beam. A recording may know the value of its scanner, "
       "which holds where this key is absent."},
      {"sample_voxel", &P::sample_voxel, 0.05, 10.0, "m", expert,
       "Edge of the voxels that each give one surface point, computed from all points in the "
       "voxel."},
      {"min_surface_points", &P::min_surface_points, 3, many, "points", expert,
       "Points that a voxel and its 6 neighbours must hold together to define a surface normal."},
      {"min_beam_spread", &P::min_beam_spread, 0.0, 10.0, "m", expert,
       "Extent of these points across the beams, which is the range times the difference of their "
       "elevations, below which one beam saw them. They then have no normal of their own and are "
       "compared with the normal of their partner.",
       min_beam_spread_choice},
      {"max_samples", &P::max_samples, 1000, many, "voxels", expert,
       "Voxels of a scan at most. The remaining points are left out and counted."},
      {"scan_to_scan", &P::scan_to_scan, expert,
       "Whether a scan is compared with the previous scan alone, as in the thesis, rather than "
       "with the local map."},
      {"map_voxel", &P::map_voxel, 0.1, 10.0, "m", expert, "Edge of the voxels of the local map."},
      {"map_spacing", &P::map_spacing, 0.0, 100.0, "m", expert,
       "Smallest distance between two surface points of the local map."},
      {"map_radius", &P::map_radius, 0.0, 10'000.0, "m", expert,
       "Surface points farther from the vehicle are removed from the local map."},
      {"map_max_voxels", &P::map_max_voxels, 1000, many, "voxels", expert,
       "Voxels of the local map at most. The default takes 22 MB of memory."},
      {"plane_thickness", &P::plane_thickness, 1e-4, 1.0, "1", expert,
       "Ratio of the variance across a surface to the variance along it (epsilon of Segal et "
       "al.)."},
      {"constant_motion", &P::constant_motion, expert,
       "Whether a scan without a visual motion is seeded by the previous motion rather than by the "
       "previous pose."},
      {"max_distance", &P::max_distance, above_zero, 100.0, "m", expert,
       "Distance between partners at most in the first iteration."},
      {"unseeded_distance", &P::unseeded_distance, above_zero, 100.0, "m", expert,
       "The same where nothing is known about the motion. The default covers 40 m/s."},
      {"min_distance", &P::min_distance, above_zero, 100.0, "m", expert,
       "Lower limit of that distance, which shrinks by a third with each iteration."},
      {"kernel", &P::kernel, above_zero, 1e6, "1", expert,
       "Whitened distance at which a pair of points has lost three quarters of its weight."},
      {"point_sigma", &P::point_sigma, above_zero, 100.0, "m", expert,
       "Standard deviation of a point across its surface: range noise and roughness."},
      {"max_iterations", &P::max_iterations, 1, 1000, "searches", expert,
       "Searches for partners at most."},
      {"steps", &P::steps, 1, 1000, "steps", expert,
       "Steps of the optimization at most with the same partners."},
      {"translation_step", &P::translation_step, above_zero, 1.0, "m", expert,
       "An iteration with a smaller translation and a rotation below rotation_step is the last "
       "one."},
      {"rotation_step", &P::rotation_step, above_zero, 1.0, "rad", expert, "See translation_step."},
      {"min_points", &P::min_points, 10, many, "points", expert,
       "Fewer samples with a normal make the scan too_few_features."},
      {"min_overlap", &P::min_overlap, above_zero, 1.0, "1", expert,
       "A smaller share of samples with a partner makes the scan too_few_inliers."},
      {"min_information", &P::min_information, above_zero, 1.0, "1", expert,
       "Information per point below which a direction of the motion counts as undetermined. "
       "Rotations are taken as metres at the mean range."},
      {"correlated_points", &P::correlated_points, above_zero, 1e6, "1", expert,
       "Factor on the covariance of independent points. Odometries from disjoint halves of the "
       "points differ over a second by what 0.05 predicts; the rest is an allowance for errors "
       "common to both halves.",
       correlated_points_choice},
      {"correct_disparities", &P::correct_disparities, expert,
       "Whether visual motions are corrected by the length that the LiDAR measured."},
      {"disparity_drift", &P::disparity_drift, 0.0, 1000.0, "px/sqrt(s)", expert,
       "Random walk of the disparity error. The error depends on the place in the image, so that "
       "the constant which stands for it changes with the scene: by 0.4 px in 10 s of the recorded "
       "drive."},
      {"min_disparity_sigma", &P::min_disparity_sigma, above_zero, 100.0, "px", expert,
       "Lower limit of the standard deviation of a measured disparity error. The scale of the "
       "scans is good to 0.1 % of the way."},
      {"max_disagreement", &P::max_disagreement, above_zero, 100.0, "m", expert,
       "A motion that differs more from its seed over one interval of 0.1 s is refused."},
      {"max_disagreement_rotation", &P::max_disagreement_rotation, above_zero, 3.2, "rad", expert,
       "The same for the rotation."},
      {"restart_after", &P::restart_after, 1, many, "scans", expert,
       "Refused scans in a row after which the local map is taken to be wrong and is started "
       "again."},
      {"max_speed", &P::max_speed, above_zero, 1e6, "m/s", usual,
       "A faster motion is refused as impossible for a road vehicle."},
      {"max_yaw_rate", &P::max_yaw_rate, above_zero, 1e6, "rad/s", usual,
       "A faster turn is refused as impossible for a road vehicle."},
      {"max_gap", &P::max_gap, above_zero, 3600.0, "s", expert,
       "An older scan is not compared with the current one."},
      {"max_stale_scans", &P::max_stale_scans, 1, many, "scans", expert,
       "Scans in a row with old stamps after which the time is taken to have started again."},
  });
  const auto rules = [](const P& p) -> std::optional<ParameterProblem> {
    if (p.max_range <= p.min_range) return {{"max_range", "must be above min_range"}};
    if (p.map_radius < p.max_range) return {{"map_radius", "must be at least max_range"}};
    if (p.min_distance > p.max_distance) return {{"min_distance", "must be at most max_distance"}};
    if (p.unseeded_distance < p.max_distance || p.unseeded_distance > 10.0 * p.map_voxel)
      return {{"unseeded_distance", "must be from max_distance to 10 map_voxel"}};
    return std::nullopt;
  };
  return {"lidar", "LiDAR odometry.", table, rules};
}

}  // namespace maploop::lidar
