// maploop evaluate: trajectories against the truth.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "msgs/frames.h"
#include "tools/command/commands.h"
#include "tools/command/json_output.h"
#include "tools/command/option_checks.h"
#include "tools/command/options.h"
#include "tools/evaluate/evaluation.h"
#include "tools/evaluate/run_errors.h"
#include "tools/evaluate/text_file.h"

namespace maploop::tools {
namespace {

struct EvaluateOptions {
  std::vector<std::filesystem::path> files;  // estimates, and without --truth the truth
  std::filesystem::path truth, json, html, tum, csv;
  std::optional<evaluation::Align> align;
  std::optional<evaluation::TableFormat> table;
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
  for (const auto& l : e.lengths) {
    lengths.push_back({{"length_m", l.length_m},
                       {"raw", to_json(l.raw)},
                       {"common_rotation_removed", to_json(l.common_rotation_removed)}});
  }
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

evaluation::StampedTrajectory read_truth(const EvaluateOptions& options) {
  auto truth = evaluation::read_trajectory(options.truth, evaluation::Role::truth);
  if (!options.kitti_poses_of.empty()) {
    truth.poses = evaluation::from_kitti_mercator(truth.poses, radians(options.kitti_poses_of[0]),
                                                  radians(options.kitti_poses_of[1]));
  }
  return truth;
}

// Poses match frame by frame if one trajectory has no stamps: then both begin with the same frame.
evaluation::Matched matched_with(const evaluation::StampedTrajectory& truth,
                                 const evaluation::StampedTrajectory& estimate,
                                 const std::filesystem::path& file,
                                 const EvaluateOptions& options) {
  const auto cut = [&](const auto& whole) { return between(whole, options.first, options.last); };
  const bool by_frame = estimate.stamps.empty() || truth.stamps.empty();
  evaluation::Matched matched = evaluation::match(cut(estimate), by_frame ? cut(truth) : truth,
                                                  from_seconds(options.tolerance));
  if (by_frame) {
    for (std::size_t& frame : matched.frames) frame += options.first;
  }
  if (matched.truth.size() < 3 && by_frame) {
    throw std::runtime_error(file.string() + " and " + options.truth.string() + " have " +
                             std::to_string(matched.truth.size()) +
                             " poses in common from --first to --last, and three are needed");
  }
  if (matched.truth.size() < 3) {
    throw std::runtime_error(file.string() + " and " + options.truth.string() + " have " +
                             std::to_string(matched.truth.size()) +
                             " poses at the same moments, and three are needed: do their stamps "
                             "have one clock? See --max-difference");
  }
  return matched;
}

void write_tum(const EvaluateOptions& options, const evaluation::Matched& matched,
               const Eigen::Isometry3d& moved) {
  if (matched.stamps.empty()) {
    throw std::runtime_error("--tum: " + options.files.front().string() +
                             " has no stamps; TUM's format needs them");
  }
  evaluation::StampedTrajectory aligned{matched.stamps, {}};
  for (const Eigen::Isometry3d& pose : matched.estimate) aligned.poses.push_back(moved * pose);
  evaluation::write_tum(options.tum, aligned);
}

// Returns the file's name, or its whole path if another one has the same name.
std::string name_of(const std::filesystem::path& file, const EvaluateOptions& options) {
  const auto same = std::count_if(
      options.files.begin(), options.files.end(),
      [&](const std::filesystem::path& other) { return other.filename() == file.filename(); });
  return same > 1 ? file.string() : file.filename().string();
}

int compare(const EvaluateOptions& options) {
  evaluation::Comparison comparison{
      evaluation::truth_track(options.truth.filename().string(), read_truth(options)),
      options.align.value_or(evaluation::Align::se3),
      options.lengths,
      {}};
  const evaluation::StampedTrajectory& truth = comparison.truth.trajectory;
  for (const std::filesystem::path& file : options.files) {
    const auto estimate = evaluation::in_frame_at(evaluation::read_trajectory(file), truth.origin);
    add_run(comparison, name_of(file, options), matched_with(truth, estimate, file, options),
            estimate.has_attitude);
  }
  std::cout << (options.table ? to_text(figures(comparison), *options.table) : to_text(comparison));
  if (!options.json.empty()) write_json_file(options.json, to_json(comparison));
  if (!options.tum.empty())
    write_tum(options, comparison.runs.front().matched, Eigen::Isometry3d::Identity());
  if (!options.csv.empty()) evaluation::write_text(options.csv, to_csv(comparison));
  if (!options.html.empty()) evaluation::write_text(options.html, to_html(comparison));
  return 0;
}

int evaluate(const EvaluateOptions& options) {
  const std::filesystem::path& file = options.files.front();
  const auto truth = read_truth(options), estimate = evaluation::read_trajectory(file);
  // KITTI's metric and the steps from pose to pose need attitudes.
  if (!truth.has_attitude || !estimate.has_attitude) return compare(options);
  const evaluation::Matched matched = matched_with(truth, estimate, file, options);
  const evaluation::Evaluation result = evaluation::evaluate(matched, options.lengths);
  std::cout << to_text(result);
  if (!options.json.empty()) write_json_file(options.json, to_json(result));
  if (!options.tum.empty())
    write_tum(options, matched, evaluation::best_alignment(matched.estimate, matched.truth));
  if (!options.csv.empty()) evaluation::write_text(options.csv, to_csv(result));
  if (!options.html.empty()) {
    evaluation::write_text(options.html, to_html(result, file.filename().string() + " against " +
                                                             options.truth.filename().string()));
  }
  return 0;
}

// Without --truth there are two files, and the last one is it. Throws CLI::ParseError.
void find_truth(EvaluateOptions& options) {
  if (options.files.empty()) throw CLI::RequiredError("EST");
  if (options.truth.empty()) {
    if (options.files.size() == 1) throw CLI::RequiredError("TRUTH");
    if (options.files.size() > 2)
      throw CLI::ValidationError("more than two files: which one is the truth? Give it by --truth");
    options.truth = options.files.back();
    options.files.pop_back();
  }
  if (!options.tum.empty() && options.files.size() > 1)
    throw CLI::ValidationError("--tum: it writes one trajectory; give one EST");
}

}  // namespace

void add_evaluate(CLI::App& app, Command& command) {
  auto options = std::make_shared<EvaluateOptions>();
  CLI::App* sub = app.add_subcommand(
      "evaluate",
      "Score trajectories against the truth: KITTI's metric, APE, RPE, end point. Files: KITTI or "
      "TUM poses, recorded truth (*.truth.csv), RTKLIB's .pos, plain or .gz, or logs (NAV_STATE; "
      "as truth TRUTH). Two files are EST TRUTH; for more, name the truth: A B C --truth T");
  sub->add_option("EST", options->files,
                  "Trajectories to score; without --truth the last of two is it")
      ->type_name("TEXT");
  auto* truth =
      sub->add_option("--truth", options->truth,
                      "The truth; matched by stamps where both have them, else frame by frame. "
                      "All other files are then compared with it, in one table");
  auto* align = add_choice(sub, "--align", options->align,
                           "How a run is moved onto the truth before absolute errors are taken: "
                           "none, origin (by the first pose), yaw (and translation), se3 (rigidly; "
                           "the default), sim3 (and scale). Compares as --truth does");
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
  sub->add_option(
         "--kitti-poses-of", options->kitti_poses_of,
         "The truth is in KITTI's Mercator projection, its first camera at this latitude and "
         "azimuth (deg): convert it to metres")
      ->delimiter(',')
      ->expected(2)
      ->type_name("LAT,AZIMUTH");
  sub->add_option("--csv", options->csv, "Write the errors of every pose to this file")
      ->check(writable_file());
  sub->add_option("--tum", options->tum,
                  "Write EST, aligned with the truth (one EST; the best alignment, or --align), to "
                  "this file")
      ->check(writable_file());
  sub->add_option("--json", options->json, "Write the figures to this file as JSON")
      ->check(writable_file());
  sub->add_option("--html", options->html, "Write a page with plots to this file")
      ->check(writable_file());
  auto* table = add_choice(sub, "--table", options->table, "Print the table in this format");
  sub->callback([=, &command] {
    if (!sub->get_subcommands().empty()) return;
    const bool several = !truth->empty() || !align->empty() || !table->empty();
    find_truth(*options);
    command = [options, several] { return several ? compare(*options) : evaluate(*options); };
  });
}

}  // namespace maploop::tools
