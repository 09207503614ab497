#include "estimators/lidar/surface_normals.h"

#include <Eigen/Eigenvalues>
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

}  // namespace

void surface_points(const VoxelMoments& moments, int min_points,
                    std::vector<SurfacePoint>* points) {
  points->clear();
  Eigen::SelfAdjointEigenSolver<Matrix3f> solver;
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
    if (around.count < static_cast<float>(min_points)) continue;
    solver.computeDirect(around.covariance());
    constexpr float line =
        1e-3f;  // middle to largest eigenvalue; less is one beam's trace, not a surface
    if (!(solver.eigenvalues()[1] > line * solver.eigenvalues()[2])) continue;
    const Vector3f position = (cell.cast<float>() + middle.mean()) * moments.size();
    points->push_back({position, solver.eigenvectors().col(0)});
  }
}

}  // namespace maploop::lidar
