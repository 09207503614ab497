// Registration of a scan with the local map.
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

// Runs work(0) to work(count - 1), in any order and on any threads, and returns when all are done.
using ForEachChunk = std::function<void(int count, const std::function<void(int)>& work)>;

struct Alignment {
  OdometryStatus status = OdometryStatus::too_few_features;
  Eigen::Isometry3d T_map_body = Eigen::Isometry3d::Identity();
  Degeneracy degeneracy;
  // Of independent points, in body axes at the scan, in the directions that they determine;
  // translation (m), rotation (rad).
  Matrix6d covariance = Matrix6d::Zero();
  int iterations = 0;
  int points = 0;    // offered
  int partners = 0;  // with a partner in the map
};

// Plane to plane, Gauss-Newton, Geman-McClure kernel, partners sought anew in each iteration within
// a shrinking distance, and held for a few steps that cost little. Sums are made in chunks of a
// fixed size and added in their order, so that the result has the same bits whoever runs the
// chunks. Allocates at construction alone.
class Gicp {
 public:
  Gicp(const LidarParameters& parameters, ForEachChunk for_each_chunk);

  // From `seed`; directions that the scan does not determine keep the seed's component. Where the
  // seed is not `known`, it is no better than any other: partners are sought further away, and no
  // component of it is kept. Statuses:
  //   ok
  //   too_few_features  fewer than min_points surface points
  //   too_few_inliers   fewer than min_overlap of them have a partner
  //   not_converged     still moving after max_iterations
  Alignment align(const LocalMap& map, const PreparedScan& scan, const Eigen::Isometry3d& seed,
                  bool known);

 private:
  struct Sums {
    Matrix6d H;
    Vector6d g;
    double weight = 0.0;
    double square = 0.0;  // weighted, whitened
    double range = 0.0;   // m, squared
    int partners = 0;
    void add(const Sums& other);
  };
  // A point's partner: its position and normal in the map.
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
