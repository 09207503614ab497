#include "estimators/lidar/voxel_moments.h"

#include <algorithm>

namespace maploop::lidar {

VoxelMoments::VoxelMoments(float size, int max_voxels)
    : size_(size), index_(static_cast<std::size_t>(max_voxels)) {
  voxels_.reserve(static_cast<std::size_t>(max_voxels));
}

void VoxelMoments::clear() {
  index_.clear();
  voxels_.clear();
}

bool VoxelMoments::add(const Eigen::Vector3f& position, float beam) {
  const float scale = 1.0f / size_;
  const Eigen::Vector3f p = position * scale;
  const Eigen::Vector3i cell(floor_to_int(p.x()), floor_to_int(p.y()), floor_to_int(p.z()));
  const VoxelKey key = VoxelKey::of(cell);
  const auto next = static_cast<std::int32_t>(voxels_.size());
  const std::int32_t i = index_.find_or_insert(key, next);
  if (i == VoxelIndex::none) return false;
  if (i == next) voxels_.push_back({key});
  Moments& m = voxels_[static_cast<std::size_t>(i)];
  const Eigen::Vector3i q =
      ((p - cell.cast<float>()) * static_cast<float>(Moments::resolution)).cast<int>();
  ++m.count;
  m.lowest_beam = std::min(m.lowest_beam, beam);
  m.highest_beam = std::max(m.highest_beam, beam);
  for (int a = 0; a < 3; ++a) m.sum[static_cast<std::size_t>(a)] += q[a];
  std::size_t k = 0;
  for (int a = 0; a < 3; ++a) {
    for (int b = a; b < 3; ++b) m.square[k++] += q[a] * q[b];
  }
  return true;
}

void VoxelMoments::sort() {
  std::sort(voxels_.begin(), voxels_.end(),
            [](const Moments& a, const Moments& b) { return a.key < b.key; });
  index_.clear();
  for (std::size_t i = 0; i < voxels_.size(); ++i) {
    index_.find_or_insert(voxels_[i].key, static_cast<std::int32_t>(i));
  }
}

}  // namespace maploop::lidar
