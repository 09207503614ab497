#include "tools/calibrate/extrinsics/sensor_views.h"

#include <algorithm>

#include "tools/calibrate/extrinsics/pose_chain.h"

namespace maploop::extrinsics {

std::vector<ViewPair> pair_views(std::span<const CameraView> images,
                                 std::span<const LidarView> scans,
                                 std::span<const SensorMotion> lidar_motions, double delay) {
  constexpr Duration beside = from_seconds(0.15);
  std::vector<ViewPair> pairs;
  const PoseChain chain(lidar_motions);
  for (const CameraView& image : images) {
    const Time at = image.stamp - from_seconds(delay);
    const auto apart = [&](const LidarView& s) { return std::chrono::abs(s.surfaces.stamp - at); };
    const auto nearest = std::ranges::min_element(scans, {}, apart);
    if (nearest == scans.end() || apart(*nearest) > beside) continue;
    if (const auto T = chain.motion(nearest->surfaces.stamp, at, 0.0))
      pairs.push_back({&image, &*nearest, *T, to_seconds(image.stamp - images.front().stamp)});
  }
  return pairs;
}

}  // namespace maploop::extrinsics
