// Computes the errors of several estimated trajectories against one truth.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "msgs/named_enum.h"
#include "tools/evaluate/alignment.h"
#include "tools/evaluate/evaluation.h"
#include "tools/evaluate/kitti_metric.h"

namespace maploop::evaluation {

// Absolute errors of the poses at which the truth's value is from `low` to below `high`.
struct ErrorBin {
  double low = 0.0, high = 0.0;  // the last one has no end
  Statistics absolute;           // m
  std::size_t poses = 0;
};

// The truth, and what is known at each of its poses.
struct TruthTrack {
  std::string name;
  StampedTrajectory trajectory;
  Eigen::Vector3d up;             // in its frame
  std::vector<double> time;       // s since its first pose; without stamps the pose's number
  std::vector<double> way;        // m, along it
  std::vector<double> speed;      // m/s, over half a second; empty without stamps
  std::vector<double> turn_rate;  // deg/s, about the vertical, without sign; empty without stamps
};

// Throws std::runtime_error if there are fewer than three poses.
TruthTrack truth_track(std::string name, StampedTrajectory trajectory);

// The figures of one run. Vectors have one value for each matched pose.
struct RunErrors {
  std::string name;
  Matched matched;  // the estimate is aligned
  double scale = 1.0;
  std::vector<double> horizontal, vertical, absolute;  // m; vertical: positive above the truth
  Statistics horizontal_m, vertical_m, absolute_m;     // vertical: without sign
  double distance_m = 0.0;                             // of the truth, over the matched poses
  double end_point_m = 0.0;                            // of the last matched pose
  bool has_attitude = true;
  SegmentError kitti;                  // 100 to 800 m, every tenth frame
  std::vector<SegmentError> relative;  // of each length, segments from every frame
  std::vector<ErrorBin> by_speed;      // km/h
  std::vector<ErrorBin> by_turn_rate;  // deg/s
};

struct Comparison {
  TruthTrack truth;
  Align align = Align::se3;
  std::vector<double> lengths_m;
  std::vector<RunErrors> runs;
};

// Adds a run. If it or the truth has no attitude, its relative errors are those of the aligned
// positions, and it has no relative rotation. Throws std::invalid_argument if fewer than three
// poses match.
void add_run(Comparison& comparison, std::string name, Matched matched, bool has_attitude);

// The table of all figures: a heading (figure, unit, and the names of the runs), then a row each.
struct FigureTable {
  std::vector<std::string> heading;
  std::vector<std::vector<std::string>> rows;
};
FigureTable figures(const Comparison& comparison);

enum class TableFormat : std::uint8_t { csv, latex, markdown };
constexpr auto names_of(TableFormat) {
  return names_up_to<TableFormat::markdown>({"csv", "latex", "markdown"});
}
std::string to_text(const FigureTable& table, TableFormat format);

// Returns the table and what is to be known with it, in at most 80 columns.
std::string to_text(const Comparison& comparison);

nlohmann::json to_json(const Comparison& comparison);

// Returns one line for each run and pose, with a heading: run, stamp (s; empty without), way (m),
// horizontal, vertical and absolute error (m).
std::string to_csv(const Comparison& comparison);

// Returns a page with linked plots, in one file that only needs a browser. Of each run at most
// some 10 000 poses are drawn; the smallest and the largest error of each stretch are among them.
std::string to_html(const Comparison& comparison);

}  // namespace maploop::evaluation
