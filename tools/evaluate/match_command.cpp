// maploop evaluate match: matched links against those really driven.
#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "mapmatch/network_file.h"
#include "sensors/replay/odometry_sequence.h"
#include "tools/command/commands.h"
#include "tools/command/json_output.h"
#include "tools/command/option_checks.h"
#include "tools/evaluate/log_messages.h"
#include "tools/evaluate/text_file.h"
#include "tools/match/match_score.h"
#include "tools/match/track_file.h"

namespace maploop::tools {
namespace {

struct EvaluateMatchOptions {
  std::filesystem::path matched, labels, frames, map, json, csv;
};

// When each frame of the labels was, on the clock of the matches.
std::vector<Time> frame_stamps(const EvaluateMatchOptions& options) {
  if (evaluation::is_lcm_log(options.matched))
    return sensors::OdometrySequence(options.frames, {}).image_stamps();
  std::vector<Time> stamps;
  for (const mapmatch::VehicleFix& fix : match::read_track(options.frames, {}))
    stamps.push_back(fix.stamp);
  return stamps;
}

std::string row(const match::TimedMatch& m, std::size_t frame, const match::Label& label) {
  const auto& [way, a, b, p_link, link] = m.matched;
  return fmt::format("{:.6f},{},{},{},{:.6f},{:d},{:d}\n", to_seconds(m.stamp.time_since_epoch()),
                     frame, label.way_id, way ? std::to_string(*way) : "", p_link, label.certain,
                     way == label.way_id);
}

int evaluate_match(const EvaluateMatchOptions& options) {
  std::vector<match::TimedMatch> matches = match::read_matches(options.matched);
  auto labels = match::read_labels(options.labels);
  if (!options.map.empty()) {
    const match::SegmentLinks links(mapmatch::RoadNetwork(mapmatch::open_network(options.map)));
    links.look_up(labels);
    bool found = false;
    for (match::TimedMatch& m : matches) {
      if (m.matched.way_id) m.matched.link = links.find(m.matched.node_a, m.matched.node_b);
      found |= m.matched.link.has_value();
    }
    if (!found) {
      throw std::runtime_error("no match of " + options.matched.string() + " is on a link of " +
                               options.map.string() +
                               ": is it the map that was matched to, and has the file the columns "
                               "node_a and node_b?");
    }
  }
  std::vector<Time> stamps;
  if (!options.frames.empty()) {
    stamps = frame_stamps(options);
  } else if (evaluation::is_lcm_log(options.matched)) {
    throw std::runtime_error(options.matched.string() +
                             " is a log: say when the frames were (--frames oxts/NN.csv)");
  }
  std::vector<match::MatchedFix> matched;
  std::vector<std::size_t> rows;
  std::string table = "t,frame,driven_way_id,way_id,p_link,conf,right\n";
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const auto frame =
        options.frames.empty() ? std::optional(i) : match::frame_at(matches[i].stamp, stamps);
    const auto label = frame ? labels.find(*frame) : labels.end();
    if (label == labels.end()) continue;
    matched.push_back(matches[i].matched);
    rows.push_back(*frame);
    table += row(matches[i], *frame, label->second);
  }
  if (rows.empty()) {
    throw std::runtime_error(
        options.matched.string() + " has no match at a frame of " + options.labels.string() +
        ": is it of this drive, and are the frames its rows (else: --frames)?");
  }
  match::MatchScore score;
  score.add(matched, rows, labels);
  const std::size_t frames = std::set(rows.begin(), rows.end()).size();
  std::cout << fmt::format("{} of {} labelled frames have a row in {}\n", frames, labels.size(),
                           options.matched.string())
            << match::to_text(score)
            << match::to_text(score.reliability, options.map.empty() ? "way" : "link");
  if (!options.json.empty()) write_json_file(options.json, match::to_json(score));
  if (!options.csv.empty()) evaluation::write_text(options.csv, table);
  return 0;
}

}  // namespace

void add_evaluate_match(CLI::App& evaluate, Command& command) {
  auto options = std::make_shared<EvaluateMatchOptions>();
  CLI::App* sub = evaluate.add_subcommand(
      "match",
      "Score matched links against those really driven: share, coverage, and how P(link) "
      "holds");
  sub->add_option(
         "MATCHED", options->matched,
         "CSV of `maploop match --csv` (of another matcher: with the columns t, way_id and "
         "p_link), or an LCM log with MAP_MATCH; plain or .gz")
      ->required();
  sub->add_option("LABELS", options->labels,
                  "CSV of the links really driven (frame,way_id,node_a,node_b,conf; plain or .gz)")
      ->required();
  sub->add_option(
      "--frames", options->frames,
      "Track whose rows are the frames, such as oxts/NN.csv: matches count at the frame "
      "nearest in time. Without it a CSV's rows are the frames");
  sub->add_option("--map", options->map,
                  "OpenStreetMap or network file that was matched on: P(link) is then held against "
                  "the link driven, and not only its way");
  sub->add_option("--csv", options->csv, "Write a row a match: driven, matched, P, right or not")
      ->check(writable_file());
  sub->add_option("--json", options->json, "Write the figures to this file as JSON")
      ->check(writable_file());
  sub->callback([options, &command] { command = [options] { return evaluate_match(*options); }; });
}

}  // namespace maploop::tools
