// The local map holds the recently seen surfaces.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "estimators/lidar/parameters.h"
#include "estimators/lidar/surface_point.h"
#include "estimators/lidar/voxel_index.h"

namespace maploop {
class ArchiveReader;
class ArchiveWriter;
}  // namespace maploop

namespace maploop::lidar {

// This is the surface point of the map nearest to a position.
struct Partner {
  Eigen::Vector3f offset;  // m, from the position to the point, in the map's axes
  Eigen::Vector3f normal;  // in the map's axes
};

// Stores points in a flat voxel hash of bounded size. Positions are relative to their voxel's
// corner, so they stay exact far from the origin. Several threads may read at once while no thread
// writes.
class LocalMap {
 public:
  // Makes an empty map by the parameters named map_... and reserves the memory of all its voxels.
  explicit LocalMap(const LidarParameters& parameters);

  // Removes all points and keeps the memory.
  void clear();
  bool empty() const { return voxels_.empty(); }  // whether it has no points
  std::size_t size() const { return points_; }    // number of points
  // Returns a copy of all points, in the map's frame and axes; for displays.
  std::vector<SurfacePoint> points() const;

  // Adds points that have a normal and are at least map_spacing from those in their voxel, up to
  // ten per voxel. Returns how many points found no free voxel.
  int insert(const PreparedScan& scan, const Eigen::Isometry3d& T_map_body);
  // Removes voxels further than map_radius from `position`.
  void forget(const Eigen::Vector3d& position);

  // Returns the nearest point within `distance` (m) of a position.
  std::optional<Partner> nearest(const Eigen::Vector3d& position, float distance) const;

  // Archives the map (msgs/archive.h). Loading throws ArchiveError if no map of this size can hold
  // the content.
  std::size_t largest_archive() const;  // bytes
  void archive(ArchiveWriter& ar) const;
  void archive(ArchiveReader& ar);

 private:
  static constexpr int per_voxel = 10;
  struct Voxel {
    VoxelKey key;
    int count = 0;
    std::array<Eigen::Vector3f, per_voxel> positions;  // m, from the lower corner
    std::array<Eigen::Vector3f, per_voxel> normals;
  };

  double size_;
  float spacing_;
  double radius_;
  VoxelIndex index_;
  std::vector<Voxel> voxels_;
  std::size_t points_ = 0;
};

}  // namespace maploop::lidar
