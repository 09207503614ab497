#include "estimators/lidar/surface_normals.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cstddef>

namespace maploop::lidar {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;

// Holds sums over a neighbourhood, in voxels from the lower corner of its middle one.
struct Neighbourhood {
  float count = 0.0f;
  Vector3f sum = Vector3f::Zero();
  Matrix3f square = Matrix3f::Zero();  // lower triangle
  float lowest_beam = 1.0f, highest_beam = -1.0f;

  void add(const Moments& m, const Vector3f& corner) {
    const auto n = static_cast<float>(m.count);
    constexpr float unit = 1.0f / static_cast<float>(Moments::resolution);
    const Vector3f s = Vector3f(static_cast<float>(m.sum[0]), static_cast<float>(m.sum[1]),
                                static_cast<float>(m.sum[2])) *
                       unit;
    std::size_t k = 0;
    for (int a = 0; a < 3; ++a) {
      for (int b = a; b < 3; ++b) {
        square(b, a) += static_cast<float>(m.square[k++]) * (unit * unit) + corner[a] * s[b] +
                        corner[b] * s[a] + n * corner[a] * corner[b];
      }
    }
    sum += s + n * corner;
    count += n;
    lowest_beam = std::min(lowest_beam, m.lowest_beam);
    highest_beam = std::max(highest_beam, m.highest_beam);
  }

  Matrix3f covariance() const {
    const Vector3f mean = sum / count;
    Matrix3f C = square / count;
    for (int a = 0; a < 3; ++a) {
      for (int b = a; b < 3; ++b) C(b, a) -= mean[a] * mean[b];
    }
    return C;
  }
};

// Using all 26 neighbours takes four times as long and finds the same motions.
constexpr std::array<std::array<int, 3>, 7> self_and_faces{
    {{0, 0, 0}, {-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};

// Returns zero if the points are those of one beam or of one line. `spread` (m) is their extent
// across the beams.
Vector3f normal_of(const Neighbourhood& around, float spread, float min_spread) {
  if (!(spread > min_spread)) return Vector3f::Zero();
  Eigen::SelfAdjointEigenSolver<Matrix3f> solver;
  solver.computeDirect(around.covariance());
  constexpr float line = 1e-3f;  // middle to largest eigenvalue
  if (!(solver.eigenvalues()[1] > line * solver.eigenvalues()[2])) return Vector3f::Zero();
  return solver.eigenvectors().col(0);
}

}  // namespace

void surface_points(const VoxelMoments& moments, const Vector3f& scanner,
                    const LidarParameters& parameters, std::vector<SurfacePoint>* points) {
  const auto min_points = static_cast<float>(parameters.min_surface_points);
  const auto min_spread = static_cast<float>(parameters.min_beam_spread);
  points->clear();
  for (const Moments& middle : moments.voxels()) {
    Neighbourhood around;
    const Eigen::Vector3i cell = middle.key.cell();
    for (const auto& [x, y, z] : self_and_faces) {
      const Eigen::Vector3i step(x, y, z);
      const std::int32_t i = moments.find(VoxelKey::of(cell + step));
      if (i != VoxelIndex::none) {
        around.add(moments.voxels()[static_cast<std::size_t>(i)], step.cast<float>());
      }
    }
    if (around.count < min_points) continue;
    const Vector3f position = (cell.cast<float>() + middle.mean()) * moments.size();
    const float spread = (around.highest_beam - around.lowest_beam) * (position - scanner).norm();
    points->push_back({position, normal_of(around, spread, min_spread)});
  }
}

}  // namespace maploop::lidar
