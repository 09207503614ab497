// maploop experiment match: map matching on recorded drives, with made errors.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mapmatch/network_file.h"
#include "tools/command/json_output.h"
#include "tools/command/option_checks.h"
#include "tools/command/recorded_drive_options.h"
#include "tools/experiment/experiments.h"
#include "tools/experiment/table.h"
#include "tools/match/parameter_settings.h"
#include "tools/match/recorded_drives.h"

namespace maploop::tools {
namespace {

struct MatchExperimentOptions : RecordedDriveOptions {
  std::filesystem::path json;
  bool each = false;
};

struct Scores {
  match::MatchScore ours, after_3_s, after_10_s, baseline;
  double seconds = 0.0;
  std::size_t fixes = 0;
};

struct ConditionScores {
  Scores pooled;
  std::vector<Scores> each;  // of the drives
};

experiments::Row row_of(const std::string& name, const Scores& s) {
  using experiments::number;
  const auto percent = [](double share) { return number(100.0 * share, 2); };
  const auto baseline_wrong = static_cast<double>(s.baseline.certain.wrong());
  const auto wrong = static_cast<double>(s.ours.certain.wrong());
  return {name,
          std::to_string(s.ours.all.fixes),
          percent(s.ours.all.share()),
          percent(s.after_3_s.all.share()),
          percent(s.after_10_s.all.share()),
          percent(s.baseline.all.share()),
          percent(s.ours.certain.share()),
          percent(s.after_3_s.certain.share()),
          percent(s.after_10_s.certain.share()),
          percent(s.baseline.certain.share()),
          percent(s.ours.all.coverage()),
          percent(s.baseline.all.coverage()),
          number(baseline_wrong == 0.0 ? 0.0 : wrong / baseline_wrong, 2),
          number(1e6 * s.seconds / static_cast<double>(std::max<std::size_t>(1, s.fixes)), 1)};
}

// Returns the scores for each condition.
std::vector<ConditionScores> run(const MatchExperimentOptions& options,
                                 const std::vector<match::InputCondition>& conditions) {
  const mapmatch::RoadNetwork network(mapmatch::open_network(options.map));
  const mapmatch::RuleBases rules = mapmatch::read_rule_bases(mapmatch::default_rules());
  mapmatch::MatchParameters parameters;
  match::apply_settings(options.set, parameters);
  const match::SegmentLinks links(network);
  std::vector<ConditionScores> scores(conditions.size());
  for (const std::string& name : options.sequences) {
    std::cerr << "\rsequence " << name << std::flush;
    match::RecordedDrive drive = match::read_recorded_drive(options.data, name);
    links.look_up(drive.labels);
    for (std::size_t c = 0; c < conditions.size(); ++c) {
      Scores& own = scores[c].each.emplace_back();
      for (const match::NoisyTrack& noisy : conditions[c].realizations(drive, options.seeds)) {
        mapmatch::Matcher matcher(network, rules, parameters);
        const auto start = std::chrono::steady_clock::now();
        const auto matched = match::match_track(matcher, noisy.track);
        const double seconds = to_seconds(std::chrono::steady_clock::now() - start);
        mapmatch::Matcher again(network, rules, parameters);
        mapmatch::MatchHistory history(network);
        match::match_track(again, noisy.track, {.history = &history});
        const auto after_3_s = match::match_later(history, std::chrono::seconds(3), network);
        const auto after_10_s = match::match_later(history, std::chrono::seconds(10), network);
        const auto nearest = match::nearest_segments(network, noisy.track);
        for (Scores* s : {&own, &scores[c].pooled}) {
          s->seconds += seconds;
          s->fixes += noisy.track.size();
          s->ours.add(matched, noisy.rows, drive.labels);
          s->after_3_s.add(after_3_s, noisy.rows, drive.labels);
          s->after_10_s.add(after_10_s, noisy.rows, drive.labels);
          s->baseline.add(nearest, noisy.rows, drive.labels);
        }
      }
    }
  }
  std::cerr << '\n';
  return scores;
}

int match_experiment(const MatchExperimentOptions& options) {
  const auto conditions = match::input_conditions();
  const auto scores = run(options, conditions);
  experiments::Table table{
      "Fixes on the right way: at once, 3 and 10 s later, and of the nearest segment "
      "(base)",
      {"input", "fixes", "all frames %", "3 s", "10 s", "base", "conf = 1 %", "3 s", "10 s", "base",
       "coverage %", "base", "wrong / base", "us a fix"},
      {}};
  nlohmann::json json;
  match::Reliability reliability;
  for (std::size_t c = 0; c < conditions.size(); ++c) {
    for (std::size_t d = 0; options.each && d < options.sequences.size(); ++d)
      table.rows.push_back(row_of(options.sequences[d], scores[c].each[d]));
    const Scores& pooled = scores[c].pooled;
    table.rows.push_back(row_of(conditions[c].name, pooled));
    json[conditions[c].name] = {{"ours", match::to_json(pooled.ours)},
                                {"lag 3 s", match::to_json(pooled.after_3_s)},
                                {"lag 10 s", match::to_json(pooled.after_10_s)},
                                {"baseline", match::to_json(pooled.baseline)}};
    reliability += pooled.ours.reliability;
  }
  std::cout << as_text(table) << "all conditions:\n" << match::to_text(reliability);
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
