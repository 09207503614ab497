#include "estimators/stereo/sift_front_end.h"

#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <utility>

#include "msgs/archive.h"

namespace maploop::stereo {
namespace {

// Returns for each row the nearest row of the other matrix, or -1 if the second nearest is about as
// near.
std::vector<int> nearest(const cv::Mat& from, const cv::Mat& to, double ratio) {
  std::vector<std::vector<cv::DMatch>> found;
  cv::BFMatcher(cv::NORM_L2).knnMatch(from, to, found, 2);
  std::vector<int> result(static_cast<std::size_t>(from.rows), -1);
  for (const auto& two : found)
    if (two.size() == 2 && two[0].distance < ratio * two[1].distance)
      result[static_cast<std::size_t>(two[0].queryIdx)] = two[0].trainIdx;
  return result;
}

}  // namespace

std::vector<std::pair<int, int>> match_descriptors(const cv::Mat& first, const cv::Mat& second,
                                                   double ratio) {
  std::vector<std::pair<int, int>> pairs;
  if (first.rows < 2 || second.rows < 2) return pairs;
  const std::vector<int> there = nearest(first, second, ratio);
  const std::vector<int> back = nearest(second, first, ratio);
  for (int i = 0; i < first.rows; ++i) {
    const int j = there[static_cast<std::size_t>(i)];
    if (j >= 0 && back[static_cast<std::size_t>(j)] == i) pairs.emplace_back(i, j);
  }
  return pairs;
}

SiftFrontEnd::SiftFrontEnd(const StereoCalibration&, const StereoParameters& parameters)
    : parameters_(parameters), sift_(cv::SIFT::create(parameters.sift_features)) {}

void SiftFrontEnd::describe(const StereoFrame& frame, Described* described) {
  std::vector<cv::KeyPoint> left, right;
  cv::Mat left_descriptors, right_descriptors;
  sift_->detectAndCompute(frame.left.level(0), cv::noArray(), left, left_descriptors);
  sift_->detectAndCompute(frame.right.level(0), cv::noArray(), right, right_descriptors);
  described->seen.clear();
  described->descriptors.release();
  for (const auto& [i, j] :
       match_descriptors(left_descriptors, right_descriptors, parameters_.sift_ratio)) {
    const cv::Point2f& l = left[static_cast<std::size_t>(i)].pt;
    const cv::Point2f& r = right[static_cast<std::size_t>(j)].pt;
    const StereoObservation seen{l.x, l.y, r.x, r.y};
    if (!consistent(seen, parameters_)) continue;
    described->seen.push_back(seen);
    described->descriptors.push_back(left_descriptors.row(i));
  }
  described->ids.assign(described->seen.size(), -1);
}

void SiftFrontEnd::follow(const StereoFrame&, const StereoFrame& current,
                          const std::optional<Eigen::Isometry3d>&,
                          std::vector<StereoTrack>* tracks) {
  describe(current, &current_);
  described_ = true;
  tracks->clear();
  const auto matches =
      match_descriptors(reference_.descriptors, current_.descriptors, parameters_.sift_ratio);
  std::vector<cv::Point2d> before, now;
  for (const auto& [i, j] : matches) {
    const StereoObservation& from = reference_.seen[static_cast<std::size_t>(i)];
    const StereoObservation& to = current_.seen[static_cast<std::size_t>(j)];
    before.emplace_back(from.u_left, from.v_left);
    now.emplace_back(to.u_left, to.v_left);
  }
  if (matches.size() < 8) return;
  cv::Mat fits;
  cv::findFundamentalMat(before, now, cv::FM_RANSAC, parameters_.ransac_threshold,
                         parameters_.ransac_confidence, fits);
  for (std::size_t k = 0; k < matches.size() && static_cast<int>(k) < fits.rows; ++k) {
    if (!fits.at<unsigned char>(static_cast<int>(k))) continue;
    const auto i = static_cast<std::size_t>(matches[k].first);
    const auto j = static_cast<std::size_t>(matches[k].second);
    current_.ids[j] = reference_.ids[i];
    tracks->push_back({reference_.ids[i], reference_.seen[i], current_.seen[j]});
  }
}

std::size_t SiftFrontEnd::complete(const StereoFrame& current, std::span<const StereoTrack> tracks,
                                   std::span<const int> agreeing) {
  if (!std::exchange(described_, false)) describe(current, &current_);
  std::vector<std::int64_t> go_on;
  for (const int i : agreeing) go_on.push_back(tracks[static_cast<std::size_t>(i)].id);
  std::sort(go_on.begin(), go_on.end());
  for (std::int64_t& id : current_.ids)
    if (!std::binary_search(go_on.begin(), go_on.end(), id)) id = next_id_++;
  return current_.seen.size();
}

void SiftFrontEnd::adopt() {
  std::swap(reference_, current_);
}

std::size_t SiftFrontEnd::largest_archive() const {
  // SIFT keeps all keypoints of equal strength, and one place may have several orientations.
  return 2 * static_cast<std::size_t>(parameters_.sift_features) * sizeof(std::int64_t) + 64;
}

void SiftFrontEnd::save(ArchiveWriter& ar) const {
  ar(reference_.ids, next_id_);
}

// Everything else is recomputed from the images with the same bits.
void SiftFrontEnd::load(ArchiveReader& ar, const StereoFrame& reference) {
  std::vector<std::int64_t> ids;
  ar(ids, next_id_);
  if (ids.empty()) return;
  if (!reference.left.levels().empty()) describe(reference, &reference_);
  if (ids.size() != reference_.seen.size()) ar.fail("features that its images do not show");
  reference_.ids = std::move(ids);
}

}  // namespace maploop::stereo
