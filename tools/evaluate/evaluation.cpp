#include "tools/evaluate/evaluation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "msgs/frames.h"
#include "tools/evaluate/alignment.h"
#include "tools/web/html.h"
#include "tools/web/page.h"

namespace maploop::evaluation {
namespace {

// Returns the distances of the positions after `alignment` is applied to the estimate.
std::vector<double> distances_apart(const Matched& m, const Eigen::Isometry3d& alignment) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < m.truth.size(); ++i)
    errors.push_back((alignment * m.estimate[i].translation() - m.truth[i].translation()).norm());
  return errors;
}

PoseErrors errors_of(const Matched& m) {
  PoseErrors errors;
  errors.along = distances(m.truth);
  errors.from_start = distances_apart(m, m.truth.front() * m.estimate.front().inverse());
  errors.aligned = distances_apart(m, best_alignment(m.estimate, m.truth));
  for (std::size_t i = 1; i < m.truth.size(); ++i) {
    const Eigen::Isometry3d off = (m.estimate[i - 1].inverse() * m.estimate[i]).inverse() *
                                  (m.truth[i - 1].inverse() * m.truth[i]);
    errors.step_m.push_back(off.translation().norm());
    errors.step_deg.push_back(degrees(Eigen::AngleAxisd(off.linear()).angle()));
  }
  return errors;
}

std::string of_segments(const SegmentError& error) {
  if (error.segments == 0) return "        -          -";
  return fmt::format("{:9.3f} {:10.5f}", error.percent, error.deg_per_m);
}

std::string of_statistics(const char* what, const char* unit, const Statistics& s) {
  return fmt::format("{:32} rmse {:.4f}, mean {:.4f}, median {:.4f}, max {:.4f} {}\n", what, s.rmse,
                     s.mean, s.median, s.max, unit);
}

}  // namespace

double quantile(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], at - static_cast<double>(below));
}

Statistics statistics(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  Statistics s;
  for (const double v : values) {
    s.mean += v;
    s.rmse += v * v;
  }
  const auto count = static_cast<double>(values.size());
  s.mean /= count;
  s.rmse = std::sqrt(s.rmse / count);
  s.median = quantile(values, 0.5);
  s.p95 = quantile(values, 0.95);
  s.max = values.back();
  return s;
}

web::Line seen_from_above(const std::string& name, const Trajectory& trajectory) {
  web::Line line{name, {}, {}};
  for (const Eigen::Isometry3d& pose : trajectory) {
    const Eigen::Vector3d p = trajectory.front().inverse() * pose.translation();
    line.x.push_back(p.x());
    line.y.push_back(p.z());
  }
  return line;
}

Evaluation evaluate(Matched matched, const std::vector<double>& lengths_m) {
  Evaluation e;
  e.matched = std::move(matched);
  const Trajectory& estimate = e.matched.estimate;
  const Trajectory& truth = e.matched.truth;
  e.errors = errors_of(e.matched);
  e.ape = statistics(e.errors.aligned);
  e.rpe_m = statistics(e.errors.step_m);
  e.rpe_deg = statistics(e.errors.step_deg);
  e.kitti = kitti_odometry_error(estimate, truth);
  for (const double length : lengths_m) {
    e.raw = score(estimate, truth, length);
    e.common_rotation_removed = score(estimate, truth, length, CommonRotation::remove);
    e.lengths.push_back({length, e.raw.segment, e.common_rotation_removed.segment});
  }
  return e;
}

std::string to_text(const Evaluation& e) {
  std::string text = fmt::format("{} poses, {:.1f} m\n", e.matched.truth.size(), e.raw.distance_m);
  if (e.matched.unmatched_estimate + e.matched.unmatched_truth > 0) {
    text += fmt::format(
        "not scored, for want of a partner: {} poses of the estimate, {} of the truth\n",
        e.matched.unmatched_estimate, e.matched.unmatched_truth);
  }
  text += fmt::format("end point {:.3f} m ({:.3f} %); one common rotation removed: {:.3f} m\n\n",
                      e.raw.end_point_m, e.raw.end_point_percent,
                      e.common_rotation_removed.end_point_m) +
          "segments                      %      deg/m   common rotation removed     number\n";
  for (const LengthError& l : e.lengths) {
    text += fmt::format("{:6.0f} m          {}   {} {:10}\n", l.length_m, of_segments(l.raw),
                        of_segments(l.common_rotation_removed), l.raw.segments);
  }
  text += fmt::format("KITTI, 100-800 m {} {:35}\n\n", of_segments(e.kitti), e.kitti.segments);
  text += of_statistics("APE, best rigid alignment", "m", e.ape);
  text += of_statistics("RPE, pose to pose", "m", e.rpe_m);
  text += of_statistics("RPE, pose to pose", "deg", e.rpe_deg);
  return text;
}

std::string to_csv(const Evaluation& e) {
  std::string text = "stamp,way,from_start,aligned,step,step_deg\n";
  for (std::size_t i = 0; i < e.matched.truth.size(); ++i) {
    text += fmt::format("{},{:.4f},{:.4f},{:.4f},", stamp_text(e.matched, i), e.errors.along[i],
                        e.errors.from_start[i], e.errors.aligned[i]);
    text += i == 0 ? ","
                   : fmt::format("{:.5f},{:.6f}", e.errors.step_m[i - 1], e.errors.step_deg[i - 1]);
    text += '\n';
  }
  return text;
}

std::string to_html(const Evaluation& e, const std::string& heading) {
  const auto& [along, from_start, aligned, step_m, step_deg] = e.errors;
  const std::vector<double> after_first(along.begin() + 1, along.end());
  web::Line raw{"as it is", {}, {}}, rotated{"one common rotation removed", {}, {}};
  for (const LengthError& l : e.lengths) {
    raw.x.push_back(l.length_m);
    raw.y.push_back(l.raw.percent);
    rotated.x.push_back(l.length_m);
    rotated.y.push_back(l.common_rotation_removed.percent);
  }
  const std::vector<web::Plot> plots{
      {"Seen from above",
       "right of the first camera, m",
       "ahead, m",
       {seen_from_above("truth", e.matched.truth), seen_from_above("estimate", e.matched.estimate)},
       true},
      {"Position error",
       "way, m",
       "m",
       {{"from the start", along, from_start}, {"best alignment", along, aligned}}},
      {"Error of segments", "length, m", "%", {raw, rotated}},
      {"From pose to pose", "way, m", "m", {{"translation", after_first, step_m}}},
      {"From pose to pose", "way, m", "deg", {{"rotation", after_first, step_deg}}}};
  return web::Page(heading).add("<pre>" + web::escaped(to_text(e)) + "</pre>\n").add(plots).text();
}

}  // namespace maploop::evaluation
