#include "estimators/lidar/validate.h"

#include <stdexcept>
#include <string>

namespace maploop::lidar {
namespace {

void require(bool holds, const char* what, const char* must, double value) {
  if (!holds)
    throw std::invalid_argument("LiDAR odometry: " + std::string(what) + " must be " + must +
                                ", not " + std::to_string(value));
}

void require_positive(const char* what, double value) {
  require(value > 0.0, what, "positive", value);
}

}  // namespace

void validate(const LidarParameters& p) {
  require(p.min_range >= 0.0, "min_range", "0 m or more", p.min_range);
  require(p.max_range > p.min_range && p.max_range <= 1000.0, "max_range",
          "above min_range, at most 1000 m", p.max_range);
  require(p.max_points >= 1000, "max_points", "at least 1000", p.max_points);
  require(p.elevation_correction > -0.1 && p.elevation_correction < 0.1, "elevation_correction",
          "within 0.1 rad", p.elevation_correction);
  require(p.sample_voxel >= 0.05 && p.sample_voxel <= 10.0, "sample_voxel", "0.05 to 10 m",
          p.sample_voxel);
  require(p.min_surface_points >= 3, "min_surface_points", "at least 3", p.min_surface_points);
  require(p.max_samples >= 1000 && p.max_samples <= 1'000'000, "max_samples", "1000 to 1000000",
          p.max_samples);
  require(p.map_voxel >= 0.1 && p.map_voxel <= 10.0, "map_voxel", "0.1 to 10 m", p.map_voxel);
  require(p.map_spacing >= 0.0, "map_spacing", "0 m or more", p.map_spacing);
  require(p.map_radius >= p.max_range, "map_radius", "at least max_range", p.map_radius);
  require(p.map_max_voxels >= 1000 && p.map_max_voxels <= 1'000'000, "map_max_voxels",
          "1000 to 1000000", p.map_max_voxels);
  require(p.plane_thickness >= 1e-4 && p.plane_thickness < 1.0, "plane_thickness", "1e-4 to 1",
          p.plane_thickness);
  require(p.min_distance > 0.0 && p.min_distance <= p.max_distance, "min_distance",
          "above 0, at most max_distance", p.min_distance);
  require(p.max_distance <= p.unseeded_distance && p.unseeded_distance <= 10.0 * p.map_voxel,
          "unseeded_distance", "max_distance to ten map_voxel", p.unseeded_distance);
  require(p.steps >= 1, "steps", "at least 1", p.steps);
  require_positive("kernel", p.kernel);
  require_positive("point_sigma", p.point_sigma);
  require(p.max_iterations >= 1, "max_iterations", "at least 1", p.max_iterations);
  require_positive("translation_step", p.translation_step);
  require_positive("rotation_step", p.rotation_step);
  require(p.min_points >= 10, "min_points", "at least 10", p.min_points);
  require(p.min_overlap > 0.0 && p.min_overlap <= 1.0, "min_overlap", "above 0, at most 1",
          p.min_overlap);
  require(p.min_information > 0.0 && p.min_information < 1.0, "min_information", "0 to 1",
          p.min_information);
  require_positive("correlated_points", p.correlated_points);
  require(p.disparity_drift >= 0.0, "disparity_drift", "0 px/sqrt(s) or more", p.disparity_drift);
  require_positive("min_disparity_sigma", p.min_disparity_sigma);
  require_positive("max_disagreement", p.max_disagreement);
  require_positive("max_disagreement_rotation", p.max_disagreement_rotation);
  require(p.restart_after >= 1, "restart_after", "at least 1", p.restart_after);
  require_positive("max_speed", p.max_speed);
  require_positive("max_yaw_rate", p.max_yaw_rate);
  require_positive("max_gap", p.max_gap);
  require(p.max_stale_scans >= 1, "max_stale_scans", "at least 1", p.max_stale_scans);
}

}  // namespace maploop::lidar
