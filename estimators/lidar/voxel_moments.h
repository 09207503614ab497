// The number, sum, second moments and beams of the points in each voxel of a scan are kept here.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "estimators/lidar/voxel_index.h"

namespace maploop::lidar {

// Positions are in whole units of 1/4096 voxel, so the sums do not depend on the order.
struct Moments {
  static constexpr int resolution = 4096;

  VoxelKey key;
  std::int64_t count = 0;
  std::array<std::int64_t, 3> sum{};     // from the voxel's lower corner
  std::array<std::int64_t, 6> square{};  // xx, xy, xz, yy, yz, zz
  float lowest_beam = 1.0f;  // sine of the elevation of the beams, in the scanner's axes
  float highest_beam = -1.0f;

  // Returns the mean position from the voxel's lower corner, in voxels.
  Eigen::Vector3f mean() const {
    const float scale = 1.0f / (static_cast<float>(resolution) * static_cast<float>(count));
    return Eigen::Vector3f(static_cast<float>(sum[0]), static_cast<float>(sum[1]),
                           static_cast<float>(sum[2])) *
           scale;
  }
};

class VoxelMoments {
 public:
  // `size` of a voxel is in m. Allocates only here.
  VoxelMoments(float size, int max_voxels);

  void clear();
  // `beam` is the sine of the elevation at which the scanner saw the point. Precondition:
  // |position| is below a million voxels. Returns false if no voxel is left.
  bool add(const Eigen::Vector3f& position, float beam);
  // Sorts by key. Afterwards voxels() and find() do not depend on the order of the additions.
  void sort();

  float size() const { return size_; }
  const std::vector<Moments>& voxels() const { return voxels_; }
  std::int32_t find(VoxelKey key) const { return index_.find(key); }

 private:
  float size_;
  VoxelIndex index_;
  std::vector<Moments> voxels_;
};

}  // namespace maploop::lidar
