// What LiDAR depth says of a stereo camera's disparities.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "estimators/lidar/surface_point.h"
#include "msgs/calibration.h"

namespace maploop::lidar {

struct DisparityParameters {
  double min_depth = 5.0;    // m; nearer, what both sensors see differs by their lever
  double max_depth = 40.0;   // m; further, an offset of 0.3 px is a metre, and surfaces are small
  double radius = 20.0;      // px around a feature in which surfaces are looked for
  int min_surfaces = 2;      // there; one alone may be the edge of something
  double max_spread = 0.08;  // of the depth; more is an edge, with two depths
  double max_angle_cosine = 0.15;  // of the ray to the surface's normal at least: no grazing
  double max_residual = 2.0;       // px; more is a wrong match
  double sigma_match = 0.25;       // px, of one disparity
  double sigma_depth = 0.05;       // m: range noise, the surface's roughness
  int min_features = 12;
};

// One stereo feature of the left image, rectified px.
struct DisparityFeature {
  double u = 0.0, v = 0.0;
  double disparity = 0.0;
};

// A constant that is missing in every disparity of a pair: true = measured + value.
struct DisparityMeasurement {
  double value = 0.0;     // px
  double variance = 0.0;  // px^2, of independent features: too small. Pairs of the recorded drive
                          // scatter by several times as much; weigh them by their scatter
  int features = 0;       // that have a depth and agree
};

// The ray of each feature meets the planes of the surfaces beside it; where they agree on a depth,
// it is a disparity to compare with. Not thread-safe: it keeps its buffers.
class DisparityFromDepth {
 public:
  DisparityFromDepth(const StereoCalibration& camera, const DisparityParameters& parameters);

  // `scan` prepared at the pair's stamp, with sample_voxel of 0.2 m or so: at 1 m most features
  // have no surface beside them. Nothing where fewer than min_features have a depth.
  std::optional<DisparityMeasurement> measure(const PreparedScan& scan,
                                              std::span<const DisparityFeature> features);

 private:
  struct Seen {
    Eigen::Vector2d image;  // px
    Eigen::Vector3d point;  // m, in cam
    Eigen::Vector3d normal;
  };
  struct Residual {
    double value;   // px
    double weight;  // 1 / px^2
  };

  void project(const PreparedScan& scan);
  std::optional<double> depth(const DisparityFeature& feature) const;
  DisparityMeasurement robust_mean();

  StereoCalibration camera_;
  DisparityParameters parameters_;
  Eigen::Isometry3d T_cam_body_;
  int columns_, rows_;
  std::vector<Seen> seen_;
  std::vector<std::vector<std::int32_t>> cells_;  // of `radius` px, numbers in seen_
  std::vector<Residual> residuals_;
};

}  // namespace maploop::lidar
