#include "estimators/lidar/gicp.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimators/lidar/scan_preparation.h"

namespace maploop::lidar {
namespace {

constexpr int chunk_points = 128;

void run_in_turn(int count, const std::function<void(int)>& work) {
  for (int i = 0; i < count; ++i) work(i);
}

int chunk_count(std::size_t points) {
  return static_cast<int>((points + chunk_points - 1) / chunk_points);
}

}  // namespace

void Gicp::Sums::add(const Sums& other) {
  H += other.H;
  g += other.g;
  weight += other.weight;
  square += other.square;
  range += other.range;
  partners += other.partners;
}

Gicp::Gicp(const LidarParameters& parameters, ForEachChunk for_each_chunk)
    : parameters_(parameters),
      for_each_chunk_(for_each_chunk ? std::move(for_each_chunk) : run_in_turn) {
  const auto points = static_cast<std::size_t>(parameters.max_samples);
  pairs_.reserve(points);
  chunks_.reserve(static_cast<std::size_t>(chunk_count(points)));
}

void Gicp::find_partners(const LocalMap& map, const PreparedScan& scan, const Eigen::Isometry3d& T,
                         float distance) {
  const std::size_t points = scan.points.size();
  pairs_.resize(points);
  const auto work = [&](int chunk) {
    const std::size_t begin = static_cast<std::size_t>(chunk) * chunk_points;
    for (std::size_t i = begin; i < std::min(begin + chunk_points, points); ++i) {
      const Eigen::Vector3d position = T * scan.points[i].position.cast<double>();
      const auto partner = map.nearest(position, distance);
      pairs_[i].exists = partner.has_value();
      if (!partner) continue;
      pairs_[i].target = position + partner->offset.cast<double>();
      pairs_[i].normal = partner->normal;
    }
  };
  for_each_chunk_(chunk_count(points), std::ref(work));  // std::ref, since a copy would allocate
}

Gicp::Sums Gicp::sum_chunk(const PreparedScan& scan, const Eigen::Isometry3d& T, double kernel,
                           int chunk) const {
  const auto thickness = static_cast<float>(parameters_.plane_thickness);
  // With this scale, two coincident surfaces differ by 2 point_sigma^2 across.
  const auto whitening = static_cast<float>(parameters_.plane_thickness /
                                            (parameters_.point_sigma * parameters_.point_sigma));
  const auto limit = static_cast<float>(kernel * kernel);
  const Eigen::Matrix3f R_body_map = T.linear().transpose().cast<float>();

  Matrix6f H = Matrix6f::Zero();
  Vector6f g = Vector6f::Zero();
  Sums sums;
  const std::size_t begin = static_cast<std::size_t>(chunk) * chunk_points;
  const std::size_t end = std::min(begin + chunk_points, scan.points.size());
  for (std::size_t i = begin; i < end; ++i) {
    const SurfacePoint& point = scan.points[i];
    const Pair& pair = pairs_[i];
    if (!pair.exists) continue;
    const Eigen::Vector3f d =
        R_body_map * (pair.target - T * point.position.cast<double>()).cast<float>();
    // (3) of METHOD.md
    const Eigen::Vector3f normal = R_body_map * pair.normal;
    const Eigen::Matrix3f W =
        whitening * plane_to_plane(point.has_normal() ? point.normal : normal, normal, thickness);
    const float square = d.dot(W * d);
    const float root = limit / (limit + square);  // (4) of METHOD.md
    const float weight = root * root;
    add_normal_equations(point.position, d, W, weight, &H, &g);
    sums.weight += static_cast<double>(weight);
    sums.square += static_cast<double>(weight * square);
    sums.range += static_cast<double>(point.position.squaredNorm());
    ++sums.partners;
  }
  sums.H = H.cast<double>();
  sums.g = g.cast<double>();
  return sums;
}

Gicp::Sums Gicp::linearize(const PreparedScan& scan, const Eigen::Isometry3d& T, double kernel) {
  const int count = chunk_count(scan.points.size());
  chunks_.resize(static_cast<std::size_t>(count));
  const auto work = [&](int chunk) {
    chunks_[static_cast<std::size_t>(chunk)] = sum_chunk(scan, T, kernel, chunk);
  };
  for_each_chunk_(count, std::ref(work));
  Sums total;
  total.H.setZero();
  total.g.setZero();
  for (const Sums& sums : chunks_) total.add(sums);
  total.H = Matrix6d(total.H.selfadjointView<Eigen::Lower>());
  return total;
}

Alignment Gicp::align(const LocalMap& map, const PreparedScan& scan, const Eigen::Isometry3d& seed,
                      bool known) {
  Alignment result;
  result.T_map_body = seed;
  result.points = static_cast<int>(scan.points.size());
  if (result.points < parameters_.min_points) return result;

  // This is the information of one point along its normal, for two coincident surfaces.
  const double unit = 0.5 / (parameters_.point_sigma * parameters_.point_sigma);
  double distance = known ? parameters_.max_distance : parameters_.unseeded_distance;
  const double min_information = known ? parameters_.min_information : 0.0;
  bool settled = false, near = false;
  while (!settled && result.iterations < parameters_.max_iterations) {
    find_partners(map, scan, result.T_map_body, static_cast<float>(distance));
    ++result.iterations;
    const Eigen::Isometry3d before = result.T_map_body;
    const double kernel = parameters_.kernel * distance / parameters_.min_distance;
    bool still = false;
    for (int k = 0; k < parameters_.steps && !still; ++k) {
      const Sums sums = linearize(scan, result.T_map_body, kernel);
      result.partners = sums.partners;
      if (sums.partners < parameters_.min_overlap * result.points) {
        result.status = OdometryStatus::too_few_inliers;
        return result;
      }
      result.degeneracy = find_degeneracy(sums.H / unit, sums.partners,
                                          std::sqrt(sums.range / sums.partners), min_information);
      const Matrix6d inverse = result.degeneracy.inverse / unit;
      const Vector6d step = -inverse * sums.g;  // (6) of METHOD.md
      result.T_map_body = result.T_map_body * Twist{step.head<3>(), step.tail<3>()}.over(1.0);
      result.T_map_body.linear() =
          Eigen::Quaterniond(result.T_map_body.linear()).normalized().toRotationMatrix();
      result.covariance = inverse * std::max(1.0, sums.square / sums.weight);
      still = step.head<3>().norm() < 0.1 * parameters_.translation_step &&
              step.tail<3>().norm() < 0.1 * parameters_.rotation_step;
    }
    const Eigen::Isometry3d moved = before.inverse() * result.T_map_body;
    const double steps =
        std::max(moved.translation().norm() / parameters_.translation_step,
                 Eigen::AngleAxisd(moved.linear()).angle() / parameters_.rotation_step);
    settled = distance <= parameters_.min_distance && steps < 1.0;
    near = steps < 10.0;  // partners may alternate between iterations
    distance = std::max(parameters_.min_distance, distance * (2.0 / 3.0));
  }
  result.status = settled || near ? OdometryStatus::ok : OdometryStatus::not_converged;
  return result;
}

}  // namespace maploop::lidar
