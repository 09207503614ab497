// maploop evaluate: a trajectory against the truth.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "msgs/frames.h"
#include "tools/command/commands.h"
#include "tools/command/json_output.h"
#include "tools/command/option_checks.h"
#include "tools/evaluate/evaluation.h"
#include "tools/evaluate/text_file.h"

namespace maploop::tools {
namespace {

struct EvaluateOptions {
  std::filesystem::path estimate, truth, json, html, tum, csv;
  std::size_t first = 0, last = std::numeric_limits<std::size_t>::max();  // poses of the estimate
  std::vector<double> kitti_poses_of;  // deg: latitude and azimuth of the first camera
  std::vector<double> lengths{5.0, 10.0, 25.0, 50.0, 100.0, 200.0, 400.0, 800.0};
  double tolerance = 0.010;  // s
};

nlohmann::json to_json(const evaluation::SegmentError& error) {
  return {{"percent", error.percent}, {"deg_per_m", error.deg_per_m}, {"segments", error.segments}};
}

nlohmann::json to_json(const evaluation::Statistics& s) {
  return {{"rmse", s.rmse}, {"mean", s.mean}, {"median", s.median}, {"max", s.max}};
}

nlohmann::json to_json(const evaluation::Evaluation& e) {
  nlohmann::json lengths = nlohmann::json::array();
  for (const auto& l : e.lengths)
    lengths.push_back({{"length_m", l.length_m},
                       {"raw", to_json(l.raw)},
                       {"common_rotation_removed", to_json(l.common_rotation_removed)}});
  return {{"frames", e.matched.truth.size()},
          {"unmatched",
           {{"estimate", e.matched.unmatched_estimate}, {"truth", e.matched.unmatched_truth}}},
          {"distance_m", e.raw.distance_m},
          {"end_point_m", e.raw.end_point_m},
          {"end_point_percent", e.raw.end_point_percent},
          {"common_rotation_removed", {{"end_point_m", e.common_rotation_removed.end_point_m}}},
          {"kitti", to_json(e.kitti)},
          {"lengths", lengths},
          {"ape_m", to_json(e.ape)},
          {"rpe_m", to_json(e.rpe_m)},
          {"rpe_deg", to_json(e.rpe_deg)}};
}

evaluation::StampedTrajectory between(evaluation::StampedTrajectory whole, std::size_t first,
                                      std::size_t last) {
  const auto cut = [&](auto& values) {
    if (last < values.size()) values.resize(last + 1);
    values.erase(values.begin(),
                 values.begin() + static_cast<std::ptrdiff_t>(std::min(first, values.size())));
  };
  cut(whole.stamps);
  cut(whole.poses);
  return whole;
}

// Poses match frame by frame if one trajectory has no stamps: then both begin with the same frame.
evaluation::Matched read_matched(const EvaluateOptions& options) {
  const auto estimate = evaluation::read_trajectory(options.estimate);
  auto truth = evaluation::read_trajectory(options.truth);
  if (!options.kitti_poses_of.empty())
    truth.poses = evaluation::from_kitti_mercator(truth.poses, radians(options.kitti_poses_of[0]),
                                                  radians(options.kitti_poses_of[1]));
  if (estimate.stamps.empty() || truth.stamps.empty())
    truth = between(truth, options.first, options.last);
  return evaluation::match(between(estimate, options.first, options.last), truth,
                           from_seconds(options.tolerance));
}

void write_tum(const EvaluateOptions& options, const evaluation::Matched& matched) {
  if (matched.stamps.empty())
    throw std::runtime_error("--tum: " + options.estimate.string() +
                             " has no stamps; TUM's format needs them");
  const Eigen::Isometry3d moved = evaluation::best_alignment(matched.estimate, matched.truth);
  evaluation::StampedTrajectory aligned{matched.stamps, {}};
  for (const Eigen::Isometry3d& pose : matched.estimate) aligned.poses.push_back(moved * pose);
  evaluation::write_tum(options.tum, aligned);
}

int evaluate(const EvaluateOptions& options) {
  const evaluation::Matched matched = read_matched(options);
  if (matched.truth.size() < 3)
    throw std::runtime_error(options.estimate.string() + " and " + options.truth.string() +
                             " have " + std::to_string(matched.truth.size()) +
                             " poses at the same moments, and three are needed: do their stamps "
                             "have one clock? See --max-difference");
  const evaluation::Evaluation result = evaluation::evaluate(matched, options.lengths);
  std::cout << to_text(result);
  if (!options.json.empty()) write_json_file(options.json, to_json(result));
  if (!options.tum.empty()) write_tum(options, matched);
  if (!options.csv.empty()) evaluation::write_text(options.csv, to_csv(result));
  if (!options.html.empty())
    evaluation::write_text(options.html,
                           to_html(result, options.estimate.filename().string() + " against " +
                                               options.truth.filename().string()));
  return 0;
}

}  // namespace

void add_evaluate(CLI::App& app, Command& command) {
  auto options = std::make_shared<EvaluateOptions>();
  CLI::App* sub = app.add_subcommand(
      "evaluate",
      "Score a trajectory against the truth: KITTI's metric, APE, RPE, end point. Files: KITTI or "
      "TUM poses, or recorded truth (*.truth.csv), plain or .gz");
  auto* estimate = sub->add_option("EST", options->estimate, "Trajectory to score");
  auto* truth =
      sub->add_option("TRUTH", options->truth,
                      "The truth; matched by stamps where both have them, else frame by frame");
  add_evaluate_match(*sub, command);
  sub->add_option("--lengths", options->lengths, "Segment lengths in metres")
      ->delimiter(',')
      ->check(positive_number())
      ->capture_default_str();
  sub->add_option("--max-difference", options->tolerance, "Seconds between two stamps that match")
      ->check(number_from_zero())
      ->capture_default_str();
  sub->add_option("--first", options->first, "First pose of EST that counts, from 0")
      ->check(whole_number());
  sub->add_option("--last", options->last, "Last pose of EST that counts")->check(whole_number());
  sub->add_option("--kitti-poses-of", options->kitti_poses_of,
                  "TRUTH is in KITTI's Mercator projection, its first camera at this latitude and "
                  "azimuth (deg): convert it to metres")
      ->delimiter(',')
      ->expected(2)
      ->type_name("LAT,AZIMUTH");
  sub->add_option("--csv", options->csv, "Write the errors of every pose to this file")
      ->check(writable_file());
  sub->add_option("--tum", options->tum,
                  "Write EST, moved to its best alignment with TRUTH, to this file")
      ->check(writable_file());
  sub->add_option("--json", options->json, "Write the figures to this file as JSON")
      ->check(writable_file());
  sub->add_option("--html", options->html, "Write a page with plots to this file")
      ->check(writable_file());
  sub->callback([=, &command] {
    if (!sub->get_subcommands().empty()) return;
    for (const CLI::Option* needed : {estimate, truth})
      if (needed->empty()) throw CLI::RequiredError(needed->get_name());
    command = [options] { return evaluate(*options); };
  });
}

}  // namespace maploop::tools
