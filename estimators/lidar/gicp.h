// A scan is registered with the local map here.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <vector>

#include "estimators/lidar/degeneracy.h"
#include "estimators/lidar/gicp_factor.h"
#include "estimators/lidar/local_map.h"
#include "estimators/lidar/parameters.h"
#include "estimators/lidar/surface_point.h"
#include "msgs/odometry.h"

namespace maploop::lidar {

// Runs work(0) to work(count - 1), in any order and on any threads, and returns when all have
// finished.
using ForEachChunk = std::function<void(int count, const std::function<void(int)>& work)>;

struct Alignment {
  OdometryStatus status = OdometryStatus::too_few_features;
  Eigen::Isometry3d T_map_body = Eigen::Isometry3d::Identity();
  Degeneracy degeneracy;
  // This is the covariance of independent points in the directions that they determine, in body
  // axes at the scan: translation (m), rotation (rad).
  Matrix6d covariance = Matrix6d::Zero();
  int iterations = 0;
  int points = 0;    // surface points of the scan
  int partners = 0;  // of these, those with a partner in the map
};

// Registers plane to plane by Gauss-Newton with a Geman-McClure kernel. Each iteration searches for
// partners within a shrinking distance and keeps them for a few cheap steps. Sums are computed in
// chunks of fixed size and added in a fixed order, so the result has the same bits whichever
// threads run the chunks. Allocates only at construction. Not thread-safe.
class Gicp {
 public:
  // Without `for_each_chunk`, align() runs all chunks on its own thread.
  explicit Gicp(const LidarParameters& parameters, ForEachChunk for_each_chunk = nullptr);

  // Aligns the scan starting from `seed` (T_map_body). In directions that the scan does not
  // determine the seed's component is kept. If the seed is not `known`, partners are searched
  // within a larger distance and no component of the seed is kept. Statuses:
  //   ok
  //   too_few_features  fewer than min_points surface points
  //   too_few_inliers   less than the share min_overlap of them has a partner
  //   not_converged     still moving after max_iterations
  Alignment align(const LocalMap& map, const PreparedScan& scan, const Eigen::Isometry3d& seed,
                  bool known);

 private:
  struct Sums {
    Matrix6d H;
    Vector6d g;
    double weight = 0.0;
    double square = 0.0;  // weighted, whitened residuals
    double range = 0.0;   // m^2, sum of squared ranges
    int partners = 0;
    void add(const Sums& other);
  };
  // Holds the position and normal of a point's partner in the map.
  struct Pair {
    Eigen::Vector3d target;
    Eigen::Vector3f normal;
    bool exists = false;
  };
  void find_partners(const LocalMap& map, const PreparedScan& scan, const Eigen::Isometry3d& T,
                     float distance);
  Sums linearize(const PreparedScan& scan, const Eigen::Isometry3d& T, double kernel);
  Sums sum_chunk(const PreparedScan& scan, const Eigen::Isometry3d& T, double kernel,
                 int chunk) const;

  LidarParameters parameters_;
  ForEachChunk for_each_chunk_;
  std::vector<Pair> pairs_;  // by the scan's points
  std::vector<Sums> chunks_;
};

}  // namespace maploop::lidar
