#include "estimators/lidar/local_map.h"

#include <algorithm>
#include <cmath>

#include "msgs/archive.h"

namespace maploop::lidar {

using Eigen::Vector3d;
using Eigen::Vector3f;
using Eigen::Vector3i;

LocalMap::LocalMap(const LidarParameters& parameters)
    : size_(parameters.map_voxel),
      spacing_(static_cast<float>(parameters.map_spacing)),
      radius_(parameters.map_radius),
      index_(static_cast<std::size_t>(parameters.map_max_voxels)) {
  voxels_.reserve(static_cast<std::size_t>(parameters.map_max_voxels));
}

std::size_t LocalMap::largest_archive() const {
  return voxels_.capacity() * sizeof(Voxel) + sizeof(std::uint64_t);
}

// Archives only the filled part of each voxel.
void LocalMap::archive(ArchiveWriter& ar) const {
  ar(std::uint64_t{voxels_.size()});
  for (const Voxel& voxel : voxels_) {
    ar(voxel.key.bits, voxel.count);
    for (std::size_t k = 0; k < static_cast<std::size_t>(voxel.count); ++k) {
      ar(voxel.positions[k], voxel.normals[k]);
    }
  }
}

void LocalMap::archive(ArchiveReader& ar) {
  clear();
  const std::size_t count = ar.length();
  if (count > voxels_.capacity()) ar.fail("a map of more voxels than it may have");
  for (std::size_t i = 0; i < count; ++i) {
    Voxel& voxel = voxels_.emplace_back();
    ar(voxel.key.bits, voxel.count);
    if (voxel.count < 1 || voxel.count > per_voxel) ar.fail("a voxel of so many points");
    for (std::size_t k = 0; k < static_cast<std::size_t>(voxel.count); ++k) {
      ar(voxel.positions[k], voxel.normals[k]);
    }
    const auto number = static_cast<std::int32_t>(i);
    if (index_.find_or_insert(voxel.key, number) != number) ar.fail("a voxel that is there twice");
    points_ += static_cast<std::size_t>(voxel.count);
  }
}

void LocalMap::clear() {
  index_.clear();
  voxels_.clear();
  points_ = 0;
}

std::vector<SurfacePoint> LocalMap::points() const {
  std::vector<SurfacePoint> points;
  points.reserve(points_);
  for (const Voxel& voxel : voxels_) {
    const Vector3d corner = voxel.key.cell().cast<double>() * size_;
    for (std::size_t k = 0; k < static_cast<std::size_t>(voxel.count); ++k) {
      points.push_back(
          {(corner + voxel.positions[k].cast<double>()).cast<float>(), voxel.normals[k]});
    }
  }
  return points;
}

int LocalMap::insert(const PreparedScan& scan, const Eigen::Isometry3d& T_map_body) {
  int refused = 0;
  const Eigen::Matrix3f R = T_map_body.linear().cast<float>();
  for (const SurfacePoint& point : scan.points) {
    if (!point.has_normal()) continue;
    const Vector3d p = T_map_body * point.position.cast<double>() / size_;
    const Vector3i cell(floor_to_int(p.x()), floor_to_int(p.y()), floor_to_int(p.z()));
    const Vector3f position = ((p - cell.cast<double>()) * size_).cast<float>();
    const VoxelKey key = VoxelKey::of(cell);
    const auto next = static_cast<std::int32_t>(voxels_.size());
    const std::int32_t i = index_.find_or_insert(key, next);
    if (i == VoxelIndex::none) {
      ++refused;
      continue;
    }
    if (i == next) voxels_.emplace_back().key = key;
    Voxel& voxel = voxels_[static_cast<std::size_t>(i)];
    const auto end = voxel.positions.begin() + voxel.count;
    const bool known = std::any_of(voxel.positions.begin(), end, [&](const Vector3f& other) {
      return (other - position).squaredNorm() < spacing_ * spacing_;
    });
    if (known || voxel.count == per_voxel) continue;
    const auto k = static_cast<std::size_t>(voxel.count++);
    voxel.positions[k] = position;
    voxel.normals[k] = R * point.normal;
    ++points_;
  }
  return refused;
}

void LocalMap::forget(const Vector3d& position) {
  const auto far = std::remove_if(voxels_.begin(), voxels_.end(), [&](const Voxel& voxel) {
    return (voxel.key.cell().cast<double>() * size_ - position).squaredNorm() > radius_ * radius_;
  });
  if (far == voxels_.end()) return;
  voxels_.erase(far, voxels_.end());
  index_.clear();
  points_ = 0;
  for (std::size_t i = 0; i < voxels_.size(); ++i) {
    index_.find_or_insert(voxels_[i].key, static_cast<std::int32_t>(i));
    points_ += static_cast<std::size_t>(voxels_[i].count);
  }
}

std::optional<Partner> LocalMap::nearest(const Vector3d& position, float distance) const {
  const auto size = static_cast<float>(size_);
  const Vector3d p = position / size_;
  const Vector3i cell(floor_to_int(p.x()), floor_to_int(p.y()), floor_to_int(p.z()));
  const Vector3f within = ((p - cell.cast<double>()) * size_).cast<float>();
  // Returns the distance along an axis to the cell `step` cells away.
  const auto gap = [&](int axis, int step) {
    if (step == 0) return 0.0f;
    return step < 0 ? within[axis] - static_cast<float>(step + 1) * size
                    : static_cast<float>(step) * size - within[axis];
  };

  float best = distance * distance;
  std::optional<Partner> found;
  const auto search = [&](int x, int y, int z) {
    const float square = Vector3f(gap(0, x), gap(1, y), gap(2, z)).squaredNorm();
    if (square >= best) return;
    const std::int32_t i = index_.find(VoxelKey::of(cell + Vector3i(x, y, z)));
    if (i == VoxelIndex::none) return;
    const Voxel& voxel = voxels_[static_cast<std::size_t>(i)];
    const Vector3f here = within - size * Vector3f(static_cast<float>(x), static_cast<float>(y),
                                                   static_cast<float>(z));
    for (std::size_t k = 0; k < static_cast<std::size_t>(voxel.count); ++k) {
      const Vector3f offset = voxel.positions[k] - here;
      if (offset.squaredNorm() < best) {
        best = offset.squaredNorm();
        found = Partner{offset, voxel.normals[k]};
      }
    }
  };
  search(0, 0, 0);  // usually holds the nearest point, so most others are skipped
  const int reach = static_cast<int>(std::ceil(distance / size));
  for (int x = -reach; x <= reach; ++x) {
    for (int y = -reach; y <= reach; ++y) {
      for (int z = -reach; z <= reach; ++z) {
        if (x != 0 || y != 0 || z != 0) search(x, y, z);
      }
    }
  }
  return found;
}

}  // namespace maploop::lidar
