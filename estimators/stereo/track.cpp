#include "estimators/stereo/track.h"

#include "estimators/stereo/triangulate.h"

namespace maploop::stereo {
namespace {

constexpr double nearest_in_view = 1.0;  // m; nearer points are about to leave the image

cv::Point2f point(double u, double v) {
  return {static_cast<float>(u), static_cast<float>(v)};
}

// Returns where the feature should be seen, or its previous position if no motion is known.
ImagePoint foresee(const StereoCalibration& camera, const StereoObservation& seen,
                   const std::optional<Eigen::Isometry3d>& expected) {
  ImagePoint old = image_of(seen);
  if (!expected) return old;
  const Eigen::Vector3d p_current = *expected * triangulate(camera, old);
  return p_current.z() > nearest_in_view ? project(camera, p_current) : old;
}

}  // namespace

void track_features(const StereoCalibration& camera, const StereoParameters& parameters,
                    const StereoFrame& previous_frame, const StereoFrame& current_frame,
                    const std::vector<Feature>& features,
                    const std::optional<Eigen::Isometry3d>& expected,
                    std::vector<StereoTrack>* tracks) {
  tracks->clear();
  const std::size_t count = features.size();
  std::vector<cv::Point2f> old_left(count), old_right(count), left(count), right(count);
  std::vector<double> disparity(count);
  for (std::size_t i = 0; i < count; ++i) {
    const StereoObservation& seen = features[i].seen;
    const ImagePoint foreseen = foresee(camera, seen, expected);
    old_left[i] = point(seen.u_left, seen.v_left);
    old_right[i] = point(seen.u_right, seen.v_right);
    left[i] = point(foreseen.x(), foreseen.y());
    disparity[i] = foreseen.z();
  }
  const int coarsest = expected ? parameters.predicted_levels : parameters.pyramid_levels;

  std::vector<unsigned char> found_left, found_right, found_circle;
  track_points(previous_frame.left, current_frame.left, coarsest, parameters, old_left, &left,
               &found_left);
  for (std::size_t i = 0; i < count; ++i) right[i] = point(left[i].x - disparity[i], left[i].y);
  track_points(current_frame.left, current_frame.right, parameters.predicted_levels, parameters,
               left, &right, &found_right);
  std::vector<cv::Point2f> circle = right;
  track_points(previous_frame.right, current_frame.right, 0, parameters, old_right, &circle,
               &found_circle);

  for (std::size_t i = 0; i < count; ++i) {
    if (!found_left[i] || !found_right[i] || !found_circle[i]) continue;
    const StereoObservation seen{left[i].x, left[i].y, right[i].x, right[i].y};
    if (consistent(seen, parameters) && cv::norm(circle[i] - right[i]) <= parameters.max_closure)
      tracks->push_back({features[i].id, features[i].seen, seen});
  }
}

}  // namespace maploop::stereo
