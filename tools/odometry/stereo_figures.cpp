#include "tools/odometry/stereo_figures.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "tools/command/median.h"
#include "tools/odometry/comparison.h"
#include "tools/odometry/consistency.h"

namespace maploop::odometry {
namespace {

using evaluation::StampedTrajectory;

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

}  // namespace

void give_true_length(const StereoCalibration& camera, const StampedTrajectory& truth,
                      RelativeMotion& motion) {
  const Eigen::Isometry3d& T_body_cam = camera.T_body_cam;
  Eigen::Isometry3d of_camera = T_body_cam.inverse() * motion.T_from_to() * T_body_cam;
  const double own = of_camera.translation().norm();
  if (own > 0.0) of_camera.translation() *= true_step(truth, motion.from, motion.stamp) / own;
  const Eigen::Isometry3d of_body = T_body_cam * of_camera * T_body_cam.inverse();
  motion.translation = of_body.translation();
}

nlohmann::json stereo_figures(const std::vector<Step>& steps, const StampedTrajectory& path,
                              const StereoCalibration& camera, const StampedTrajectory& truth) {
  int pairs = 0, refused = 0;
  std::vector<double> times;
  std::set<std::int64_t> features;
  std::vector<RelativeMotion> motions;
  double tracks = 0.0, ratios = 0.0;
  for (const Step& step : steps) {
    const RelativeMotion& motion = step.motion;
    motions.push_back(motion);
    if (motion.status == OdometryStatus::first_frame) continue;
    ++pairs;
    times.push_back(step.milliseconds);
    tracks += static_cast<double>(step.tracks.size());
    for (const stereo::StereoTrack& track : step.tracks) features.insert(track.id);
    if (motion.status != OdometryStatus::ok) {
      ++refused;
    } else if (motion.tracked > 0) {
      ratios += static_cast<double>(motion.inliers) / motion.tracked;
    }
  }
  if (pairs == 0) throw std::runtime_error("--json: there are no two frames to score");
  const evaluation::Evaluation score = scored(path, truth);
  const evaluation::LengthError &shorter = score.lengths.front(), &longer = score.lengths.back();
  const auto percent = [](const evaluation::SegmentError& e) {
    return e.segments > 0 ? nlohmann::json(e.percent) : nlohmann::json();
  };
  const evaluation::SegmentError& turned = longer.common_rotation_removed;
  return {{"pairs", pairs},
          {"refused", refused},
          {"tracks_a_pair", tracks / pairs},
          {"pairs_a_track", features.empty() ? 0.0 : tracks / static_cast<double>(features.size())},
          {"inliers_percent", 100.0 * ratios / std::max(1, pairs - refused)},
          {"end_point_percent", score.raw.end_point_percent},
          {"segment_25m_turned_percent", percent(shorter.common_rotation_removed)},
          {"segment_100m_percent", percent(longer.raw)},
          {"segment_100m_turned_percent", percent(turned)},
          {"segment_100m_turned_deg_per_m",
           turned.segments > 0 ? nlohmann::json(turned.deg_per_m) : nlohmann::json()},
          {"nees", consistency(motions, camera.T_body_cam, truth).nees},
          {"processor_ms", tools::median(times)}};
}

}  // namespace maploop::odometry
