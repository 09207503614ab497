#include "tools/odometry/stereo_comparison.h"

#include <fmt/format.h>
#include <algorithm>
#include <set>
#include <stdexcept>

#include "tools/command/median.h"
#include "tools/odometry/consistency.h"
#include "tools/odometry/odometry_input.h"

namespace maploop::odometry {
namespace {

using evaluation::StampedTrajectory;
using stereo::Matching;
using stereo::MotionMethod;

// Returns the distance (m) between the truth's camera positions at two stamps, or 0 if the truth
// does not have them.
double true_step(const StampedTrajectory& truth, Time from, Time to) {
  const auto at = [&](Time stamp) {
    return std::lower_bound(truth.stamps.begin(), truth.stamps.end(), stamp) - truth.stamps.begin();
  };
  const auto size = static_cast<std::ptrdiff_t>(truth.stamps.size());
  const std::ptrdiff_t first = at(from), last = at(to);
  if (last >= size || truth.stamps[static_cast<std::size_t>(first)] != from ||
      truth.stamps[static_cast<std::size_t>(last)] != to)
    return 0.0;
  return (truth.poses[static_cast<std::size_t>(last)].translation() -
          truth.poses[static_cast<std::size_t>(first)].translation())
      .norm();
}

void give_length(const Eigen::Isometry3d& T_body_cam, double length, RelativeMotion* motion) {
  Eigen::Isometry3d of_camera = T_body_cam.inverse() * motion->T_from_to() * T_body_cam;
  const double own = of_camera.translation().norm();
  if (own > 0.0) of_camera.translation() *= length / own;
  const Eigen::Isometry3d of_body = T_body_cam * of_camera * T_body_cam.inverse();
  motion->translation = of_body.translation();
}

}  // namespace

std::vector<Variant> variants(bool images, bool scans) {
  std::vector<Variant> all{
      {"KLT, 3D-2D", Matching::klt, MotionMethod::points_to_image, 0},
      {"KLT, 3D-2D, window of 6", Matching::klt, MotionMethod::points_to_image, 6},
      {"the same, disparities as rectified", Matching::klt, MotionMethod::points_to_image, 6,
       Disparities::none},
      {"KLT, 3D-3D", Matching::klt, MotionMethod::points_to_points, 0},
      {"KLT, 2D-2D", Matching::klt, MotionMethod::image_to_image, 0}};
  if (scans) {
    all.insert(all.begin() + 3, {"the same, disparities by LiDAR", Matching::klt,
                                 MotionMethod::points_to_image, 6, Disparities::lidar});
  }
  if (images) {
    all.push_back({"SIFT, 3D-2D", Matching::sift, MotionMethod::points_to_image, 0});
    all.push_back({"SIFT, 3D-3D", Matching::sift, MotionMethod::points_to_points, 0});
  }
  return all;
}

Comparison stereo_comparison() {
  return {{"way", "tracks a pair", "pairs a track", "inliers, %", "refused", "end point, %",
           "25 m turned, %", "100 m, %", "100 m turned, %", "turned, deg/m", "NEES", "ms a pair"},
          "turned: with one common rotation between the truth's axes and the camera's removed. "
          "2D-2D: the left camera alone, its motions given the truth's lengths. NEES: a degree of "
          "freedom, of increments of 1 s; 1 is right. Times are processor times without decoding "
          "of images."};
}

Compared run_variant(const Variant& variant, const InputFiles& files, FrameRange frames,
                     const StampedTrajectory& truth) {
  const Input opened = open_input(files, frames, variant.disparities,
                                  [&variant](stereo::StereoParameters& parameters) {
                                    parameters.matching = variant.matching;
                                    parameters.motion = variant.motion;
                                    parameters.window_frames = variant.window_frames;
                                  });
  int pairs = 0, refused = 0;
  CameraPath path(opened.camera.T_body_cam);
  std::vector<double> times;
  std::set<std::int64_t> features;
  std::vector<RelativeMotion> motions;
  double tracks = 0.0, ratios = 0.0;
  while (auto step = opened.run()) {
    RelativeMotion& motion = step->motion;
    if (motion.status == OdometryStatus::ok && variant.motion == MotionMethod::image_to_image)
      give_length(opened.camera.T_body_cam, true_step(truth, motion.from, motion.stamp), &motion);
    path.add(motion);
    motions.push_back(motion);
    if (motion.status == OdometryStatus::first_frame) continue;
    ++pairs;
    times.push_back(step->milliseconds);
    tracks += static_cast<double>(step->tracks.size());
    for (const stereo::StereoTrack& track : step->tracks) features.insert(track.id);
    if (motion.status != OdometryStatus::ok) {
      ++refused;
    } else if (motion.tracked > 0) {
      ratios += static_cast<double>(motion.inliers) / motion.tracked;
    }
  }
  if (pairs == 0) throw std::runtime_error(files.input.string() + " has no two frames to compare");
  const evaluation::Evaluation score = scored(path.trajectory(), truth);
  const evaluation::LengthError& longer = score.lengths.back();
  const evaluation::SegmentError& turned = longer.common_rotation_removed;
  const double life = features.empty() ? 0.0 : tracks / static_cast<double>(features.size());
  return {{variant.name, fmt::format("{:.0f}", tracks / pairs), fmt::format("{:.1f}", life),
           fmt::format("{:.0f}", 100.0 * ratios / std::max(1, pairs - refused)),
           std::to_string(refused), fmt::format("{:.2f}", score.raw.end_point_percent),
           percent_cell(score.lengths.front().common_rotation_removed), percent_cell(longer.raw),
           percent_cell(turned), turning_cell(turned),
           fmt::format("{:.2f}", consistency(motions, opened.camera.T_body_cam, truth).nees),
           fmt::format("{:.1f}", tools::median(times))},
          score};
}

}  // namespace maploop::odometry
