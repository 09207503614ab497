// maploop experiment match: map matching on recorded drives, with made errors.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "mapmatch/network_file.h"
#include "tools/command/json_output.h"
#include "tools/command/option_checks.h"
#include "tools/command/recorded_drive_options.h"
#include "tools/experiment/experiments.h"
#include "tools/match/match_score.h"
#include "tools/match/parameter_settings.h"
#include "tools/match/recorded_drives.h"
#include "tools/match/score_output.h"

namespace maploop::tools {
namespace {

struct MatchExperimentOptions : RecordedDriveOptions {
  std::filesystem::path json;
  bool each = false;
};

struct Scores {
  match::MatchScore ours, baseline;
  double seconds = 0.0;
  std::size_t fixes = 0;
};

void run(const mapmatch::RoadNetwork& network, const mapmatch::RuleBases& rules,
         const mapmatch::MatchParameters& parameters, const match::RecordedDrive& sequence,
         const match::InputCondition& condition, int seeds, Scores& scores) {
  for (int seed = 1; seed <= condition.realizations(seeds); ++seed) {
    const auto [track, rows] = match::noisy_track(sequence, condition, seed);
    mapmatch::Matcher matcher(network, rules, parameters);
    const auto start = std::chrono::steady_clock::now();
    const auto matched = match::match_track(matcher, track);
    scores.seconds += to_seconds(std::chrono::steady_clock::now() - start);
    scores.fixes += track.size();
    scores.ours.add(matched, rows, sequence.labels);
    scores.baseline.add(match::nearest_segments(network, track), rows, sequence.labels);
  }
}

void print_row(const char* name, const Scores& s) {
  std::printf("%-26s %7zu  %6.2f %6.2f  %6.2f %6.2f  %6.2f %6.2f  %6.2f  %5.1f\n", name,
              s.ours.all.fixes, 100 * s.ours.all.share(), 100 * s.baseline.all.share(),
              100 * s.ours.certain.share(), 100 * s.baseline.certain.share(),
              100 * s.ours.all.coverage(), 100 * s.baseline.all.coverage(),
              s.baseline.certain.wrong() == 0 ? 0.0
                                              : static_cast<double>(s.ours.certain.wrong()) /
                                                    static_cast<double>(s.baseline.certain.wrong()),
              1e6 * s.seconds / static_cast<double>(std::max<std::size_t>(1, s.fixes)));
  std::fflush(stdout);
}

int match_experiment(const MatchExperimentOptions& options) {
  const mapmatch::RoadNetwork network(mapmatch::open_network(options.map));
  const mapmatch::RuleBases rules = mapmatch::read_rule_bases(mapmatch::default_rules());
  const mapmatch::MatchParameters parameters = match::parameters_with(options.set);
  std::vector<match::RecordedDrive> sequences;
  const match::SegmentLinks links(network);
  for (const std::string& name : options.sequences) {
    sequences.push_back(match::read_recorded_drive(options.data, name));
    links.look_up(sequences.back().labels);
  }
  std::printf("%-26s %7s  %-13s  %-13s  %-13s  %-6s  %s\n", "input", "fixes", "all frames %",
              "conf = 1 %", "coverage %", "wrong", "us a fix");
  std::printf("%-26s %7s  %6s %6s  %6s %6s  %6s %6s  %6s\n", "", "", "ours", "base", "ours", "base",
              "ours", "base", "/base");
  nlohmann::json json;
  match::Reliability reliability;
  for (const match::InputCondition& condition : match::input_conditions()) {
    Scores pooled;
    for (const match::RecordedDrive& sequence : sequences) {
      Scores own;
      run(network, rules, parameters, sequence, condition, options.seeds,
          options.each ? own : pooled);
      if (options.each) {
        print_row(("  " + sequence.name).c_str(), own);
        run(network, rules, parameters, sequence, condition, options.seeds, pooled);
      }
    }
    print_row(condition.name, pooled);
    json[condition.name] = {{"ours", match::to_json(pooled.ours)},
                            {"baseline", match::to_json(pooled.baseline)}};
    for (std::size_t k = 0; k < reliability.fixes.size(); ++k) {
      reliability.fixes[k] += pooled.ours.reliability.fixes[k];
      reliability.right[k] += pooled.ours.reliability.right[k];
      reliability.p_sum[k] += pooled.ours.reliability.p_sum[k];
    }
  }
  std::cout << "all conditions:\n" << match::to_text(reliability);
  if (!options.json.empty()) write_json_file(options.json, json);
  return 0;
}

}  // namespace

void add_match_experiment(CLI::App& experiment, Command& command) {
  auto options = std::make_shared<MatchExperimentOptions>();
  CLI::App* sub = experiment.add_subcommand(
      "match",
      "Map matching against labels of the links driven, beside the nearest segment with an azimuth "
      "gate: without noise, with white and with Gauss-Markov noise, at 1 and 10 Hz");
  add_recorded_drive_options(*sub, *options, "OpenStreetMap file, or a network file");
  sub->add_flag("--each", options->each, "A line for each sequence, too");
  sub->add_option("--json", options->json, "Write the figures to this file as JSON")
      ->check(writable_file());
  sub->callback(
      [options, &command] { command = [options] { return match_experiment(*options); }; });
}

}  // namespace maploop::tools
