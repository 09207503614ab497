#include "tools/odometry/comparison.h"

#include <fmt/format.h>
#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

#include "tools/command/median.h"
#include "tools/odometry/odometry_input.h"
#include "tools/web/html.h"
#include "tools/web/page.h"
#include "tools/web/table.h"

namespace maploop::odometry {
namespace {

using evaluation::StampedTrajectory;
using stereo::Matching;
using stereo::MotionMethod;

constexpr double kSegment = 100.0;  // m
constexpr double kShort = 25.0;  // m, for drives that have hardly any segment of the other length

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

std::vector<std::string> cells(const VariantResult& r) {
  const evaluation::Score& raw = r.score.raw;
  const auto segment = [](const evaluation::SegmentError& e) {
    return e.segments > 0 ? fmt::format("{:.2f}", e.percent) : std::string("-");
  };
  const evaluation::LengthError& shorter = r.score.lengths.front();
  const evaluation::LengthError& longer = r.score.lengths.back();
  const evaluation::SegmentError& turned = longer.common_rotation_removed;
  return {r.variant.name,
          fmt::format("{:.0f}", r.tracks),
          fmt::format("{:.1f}", r.life),
          fmt::format("{:.0f}", 100.0 * r.inlier_ratio),
          fmt::format("{}", r.refused),
          fmt::format("{:.2f}", raw.end_point_percent),
          segment(shorter.common_rotation_removed),
          segment(longer.raw),
          segment(turned),
          turned.segments > 0 ? fmt::format("{:.4f}", turned.deg_per_m) : std::string("-"),
          fmt::format("{:.2f}", r.consistency.nees),
          fmt::format("{:.1f}", r.milliseconds)};
}

const std::vector<std::string> kHeadings = {
    "way",          "tracks a pair",  "pairs a track", "inliers, %",      "refused",
    "end point, %", "25 m turned, %", "100 m, %",      "100 m turned, %", "turned, deg/m",
    "NEES",         "ms a pair"};

const char* const kNotes =
    "turned: with one common rotation between the truth's axes and the camera's removed. 2D-2D: "
    "the "
    "left camera alone, its motions given the truth's lengths. NEES: a degree of freedom, of "
    "increments of 1 s; 1 is right. Times are processor times without decoding of images.";

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

VariantResult run_variant(const Variant& variant, const std::filesystem::path& input,
                          const std::filesystem::path& config, FrameRange frames,
                          const StampedTrajectory& truth) {
  const Input opened = open_input(input, config, frames, variant.disparities,
                                  [&variant](stereo::StereoParameters& parameters) {
                                    parameters.matching = variant.matching;
                                    parameters.motion = variant.motion;
                                    parameters.window_frames = variant.window_frames;
                                  });
  VariantResult result;
  result.variant = variant;
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
    ++result.pairs;
    times.push_back(step->milliseconds);
    tracks += static_cast<double>(step->tracks.size());
    for (const stereo::StereoTrack& track : step->tracks) features.insert(track.id);
    if (motion.status != OdometryStatus::ok) {
      ++result.refused;
    } else if (motion.tracked > 0) {
      ratios += static_cast<double>(motion.inliers) / motion.tracked;
    }
  }
  if (result.pairs == 0) throw std::runtime_error(input.string() + " has no two frames to compare");
  result.tracks = tracks / result.pairs;
  result.life = features.empty() ? 0.0 : tracks / static_cast<double>(features.size());
  result.inlier_ratio = ratios / std::max(1, result.pairs - result.refused);
  result.milliseconds = tools::median(times);
  result.consistency = consistency(motions, opened.camera.T_body_cam, truth);
  result.score = evaluation::evaluate(
      evaluation::match(path.trajectory(), truth, from_seconds(0.001)), {kShort, kSegment});
  return result;
}

std::string to_text(const std::vector<VariantResult>& results) {
  std::string text;
  const auto line = [&text](const std::vector<std::string>& row) {
    text += fmt::format("{:34}", row[0]);
    for (std::size_t i = 1; i < row.size(); ++i)
      text += fmt::format("{:>{}}", row[i], static_cast<int>(kHeadings[i].size()) + 2);
    text += '\n';
  };
  line(kHeadings);
  for (const VariantResult& result : results) line(cells(result));
  return text + kNotes + '\n';
}

std::string to_html(const std::vector<VariantResult>& results, const std::string& heading) {
  std::vector<web::Row> rows;
  web::Plot paths{"Seen from above", "right of the first camera, m", "ahead, m", {}, true};
  web::Plot errors{"Position error", "way, m", "m", {}};
  for (const VariantResult& result : results) {
    rows.push_back(cells(result));
    const evaluation::Matched& matched = result.score.matched;
    if (paths.lines.empty())
      paths.lines.push_back(evaluation::seen_from_above("truth", matched.truth));
    paths.lines.push_back(evaluation::seen_from_above(result.variant.name, matched.estimate));
    errors.lines.push_back(
        {result.variant.name, result.score.errors.along, result.score.errors.from_start});
  }
  return web::Page(heading)
      .add(web::table(kHeadings, rows) + "<p>" + web::escaped(kNotes) + "</p>\n")
      .add({paths, errors})
      .text();
}

}  // namespace maploop::odometry
