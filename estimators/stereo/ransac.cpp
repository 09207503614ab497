#include "estimators/stereo/ransac.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "estimators/stereo/p3p.h"
#include "estimators/stereo/point_alignment.h"
#include "estimators/stereo/triangulate.h"

namespace maploop::stereo {
namespace {

// The generator is SplitMix64 (Steele, Lea, Flood, "Fast splittable pseudorandom number
// generators", OOPSLA 2014).
class RandomSequence {
 public:
  explicit RandomSequence(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    state_ += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

  // Returns a number in [0, bound). bound must be > 0 and far below 2^32, so that the bias is
  // negligible.
  int below(int bound) {
    return static_cast<int>(((next() >> 32) * static_cast<std::uint64_t>(bound)) >> 32);
  }

 private:
  std::uint64_t state_;
};

class MotionScore {
 public:
  MotionScore(const StereoCalibration& camera, std::span<const StereoTrack> tracks,
              double threshold)
      : camera_(camera), tracks_(tracks), threshold2_(threshold * threshold) {
    points_.reserve(tracks.size());
    for (const StereoTrack& track : tracks)
      points_.push_back(triangulate(camera, image_of(track.previous)));
  }

  const Eigen::Vector3d& point(int i) const { return points_[static_cast<std::size_t>(i)]; }

  // Returns the larger of the squared errors in the two images, px^2, truncated at the squared
  // threshold.
  double truncated_error(const Eigen::Isometry3d& T_current_previous, std::size_t i) const {
    const Eigen::Vector3d p_cam = T_current_previous * points_[i];
    if (p_cam.z() <= 0.0) return threshold2_;
    const ImagePoint image = project(camera_, p_cam);
    const StereoObservation& seen = tracks_[i].current;
    const double u_left = image.x() - seen.u_left;
    const double u_right = image.x() - image.z() - seen.u_right;
    const double v = image.y() - seen.v_left;
    return std::min(std::max(u_left * u_left, u_right * u_right) + v * v, threshold2_);
  }

  double cost(const Eigen::Isometry3d& T_current_previous, double give_up) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < points_.size() && sum < give_up; ++i)
      sum += truncated_error(T_current_previous, i);
    return sum;
  }

  void collect_inliers(const Eigen::Isometry3d& T_current_previous,
                       std::vector<int>* inliers) const {
    inliers->clear();
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (truncated_error(T_current_previous, i) < threshold2_)
        inliers->push_back(static_cast<int>(i));
  }

 private:
  const StereoCalibration& camera_;
  std::span<const StereoTrack> tracks_;
  double threshold2_;
  std::vector<Eigen::Vector3d> points_;
};

std::array<int, 3> draw_three(int count, RandomSequence* random) {
  std::array<int, 3> drawn{};
  drawn[0] = random->below(count);
  do drawn[1] = random->below(count);
  while (drawn[1] == drawn[0]);
  do drawn[2] = random->below(count);
  while (drawn[2] == drawn[0] || drawn[2] == drawn[1]);
  return drawn;
}

// Returns T_current_previous of three tracks.
P3pSolutions resect(const StereoCalibration& camera, const MotionScore& score,
                    std::span<const StereoTrack> tracks, const std::array<int, 3>& drawn) {
  std::array<Eigen::Vector3d, 3> points, bearings;
  for (std::size_t j = 0; j < 3; ++j) {
    const StereoObservation& seen = tracks[static_cast<std::size_t>(drawn[j])].current;
    points[j] = score.point(drawn[j]);
    bearings[j] = triangulate(camera, {seen.u_left, seen.v_left, 1.0}).normalized();
  }
  return solve_p3p(points, bearings);
}

P3pSolutions align(const StereoCalibration& camera, const StereoParameters& parameters,
                   std::span<const StereoTrack> tracks, const std::array<int, 3>& drawn) {
  P3pSolutions solutions;
  const auto T_previous_current = align_points(camera, parameters, tracks, drawn);
  if (!T_previous_current) return solutions;
  solutions.count = 1;
  solutions.T_camera_world[0] = T_previous_current->inverse();
  return solutions;
}

int hypotheses_needed(double inlier_ratio, const StereoParameters& parameters) {
  const double all_good = inlier_ratio * inlier_ratio * inlier_ratio;
  if (all_good < 1e-9) return parameters.ransac_max_hypotheses;
  if (all_good > 1.0 - 1e-9) return 1;
  // (3) of METHOD.md
  const double needed = std::log(1.0 - parameters.ransac_confidence) / std::log(1.0 - all_good);
  return static_cast<int>(
      std::min(std::ceil(needed), static_cast<double>(parameters.ransac_max_hypotheses)));
}

}  // namespace

Consensus ransac_motion(const StereoCalibration& camera, const StereoParameters& parameters,
                        std::span<const StereoTrack> tracks, std::uint64_t seed,
                        const std::optional<Eigen::Isometry3d>& expected) {
  Consensus best;
  const int count = static_cast<int>(tracks.size());
  if (count < 3) return best;

  const MotionScore score(camera, tracks, parameters.ransac_threshold);
  double best_cost = std::numeric_limits<double>::infinity();
  int needed = parameters.ransac_max_hypotheses;
  const auto offer = [&](const Eigen::Isometry3d& T_current_previous) {
    const double cost = score.cost(T_current_previous, best_cost);
    if (!(cost < best_cost)) return;
    best_cost = cost;
    best.T_current_previous = T_current_previous;
    score.collect_inliers(T_current_previous, &best.inliers);
    needed = hypotheses_needed(static_cast<double>(best.inliers.size()) / count, parameters);
  };

  if (expected) offer(*expected);
  RandomSequence random(seed);
  for (; best.hypotheses < needed; ++best.hypotheses) {
    const std::array<int, 3> drawn = draw_three(count, &random);
    const P3pSolutions solutions = parameters.motion == MotionMethod::points_to_points
                                       ? align(camera, parameters, tracks, drawn)
                                       : resect(camera, score, tracks, drawn);
    for (int j = 0; j < solutions.count; ++j)
      offer(solutions.T_camera_world[static_cast<std::size_t>(j)]);
  }
  return best;
}

}  // namespace maploop::stereo
