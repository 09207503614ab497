// maploop experiment match: map matching on recorded drives, with made errors.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
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
#include "tools/match/baseline_matchers.h"
#include "tools/match/recorded_drives.h"
#include "tools/match/route_score.h"
#include "tools/match/track_matching.h"

namespace maploop::tools {
namespace {

struct MatchExperimentOptions : RecordedDriveOptions {
  std::filesystem::path json;
  double beta = 5.0;  // m
  bool each = false;
};

// A way to match the fixes of a track.
struct NamedMatcher {
  const char* name;
  std::function<std::vector<match::MatchedFix>(const match::Track&)> match;
};

struct Scores {
  match::MatchScore score;
  double seconds = 0.0;
  std::size_t fixes = 0;

  Scores& operator+=(const Scores& more) {
    score += more.score;
    seconds += more.seconds;
    fixes += more.fixes;
    return *this;
  }
};

struct Case {
  std::string name;
  std::vector<Scores> scores{};  // by matcher
  match::RouteScore route{};     // by the fixes of 10 s
};

std::vector<NamedMatcher> matchers(const mapmatch::RoadNetwork& network,
                                   const mapmatch::RuleBases& rules,
                                   const mapmatch::MatchParameters& parameters, double beta) {
  mapmatch::MatchParameters alone = parameters;
  alone.paths = false;
  const auto at_once = [&network, &rules](const mapmatch::MatchParameters& p) {
    return [&network, &rules, p](const match::Track& track) {
      mapmatch::Matcher matcher(network, rules, p);
      return match::match_track(matcher, track);
    };
  };
  const auto later = [&network, &rules, parameters](Duration lag) {
    return [&network, &rules, parameters, lag](const match::Track& track) {
      mapmatch::Matcher matcher(network, rules, parameters);
      mapmatch::MatchHistory history(network);
      match::match_track(matcher, track, {.history = &history});
      return match::match_later(history, lag, network);
    };
  };
  return {
      {"ours", at_once(parameters)},
      {"3 s", later(std::chrono::seconds(3))},
      {"10 s", later(std::chrono::seconds(10))},
      {"rules", at_once(alone)},
      {"nearest", [&](const auto& track) { return match::nearest_segments(network, track); }},
      {"weights", [&](const auto& track) { return match::topological_weights(network, track); }},
      {"ellipse", [&](const auto& track) { return match::probabilistic_ellipse(network, track); }},
      {"HMM",
       [&network, beta](const auto& track) { return match::hidden_markov(network, track, beta); }}};
}

Scores run(const NamedMatcher& matcher, const match::RecordedDrive& drive,
           const std::vector<match::NoisyTrack>& tracks) {
  Scores scores;
  for (const match::NoisyTrack& noisy : tracks) {
    const auto start = std::chrono::steady_clock::now();
    const auto matched = matcher.match(noisy.track);
    scores.seconds += to_seconds(std::chrono::steady_clock::now() - start);
    scores.fixes += noisy.track.size();
    scores.score.add(matched, noisy.rows, drive.labels);
  }
  return scores;
}

// Returns the scores for each condition, and before them those of each drive if they are wanted.
std::vector<Case> run_all(const MatchExperimentOptions& options,
                          const mapmatch::RoadNetwork& network,
                          const std::vector<NamedMatcher>& all) {
  const match::SegmentLinks links(network);
  const mapmatch::RuleBases rules = options.rule_bases();
  const mapmatch::MatchParameters parameters = options.parameters();
  const match::TrackMatching whole{network, rules, parameters, std::chrono::seconds(10)};
  const std::vector<match::InputCondition> conditions = match::input_conditions();
  std::vector<std::vector<Case>> drives(conditions.size());
  std::vector<Case> pooled;
  pooled.reserve(conditions.size());
  for (const match::InputCondition& condition : conditions)
    pooled.push_back({condition.name, std::vector<Scores>(all.size())});
  for (const std::string& name : options.sequences) {
    std::cerr << "\rsequence " << name << std::flush;
    match::RecordedDrive drive = match::read_recorded_drive(options.data, name);
    links.look_up(drive.labels);
    for (std::size_t c = 0; c < conditions.size(); ++c) {
      const auto tracks = conditions[c].realizations(drive, options.seeds);
      Case& own = drives[c].emplace_back(Case{name});
      for (std::size_t m = 0; m < all.size(); ++m) {
        own.scores.push_back(run(all[m], drive, tracks));
        pooled[c].scores[m] += own.scores.back();
      }
      for (const match::NoisyTrack& noisy : tracks) {
        own.route += match::score_route(whole.match(noisy.track, name, nullptr), noisy.rows,
                                        drive.labels, network);
      }
      pooled[c].route += own.route;
    }
  }
  std::cerr << '\n';
  std::vector<Case> cases;
  for (std::size_t c = 0; c < conditions.size(); ++c) {
    if (options.each) cases.insert(cases.end(), drives[c].begin(), drives[c].end());
    cases.push_back(std::move(pooled[c]));
  }
  return cases;
}

template <class Figure>
experiments::Table table_of(const char* title, const std::vector<NamedMatcher>& all,
                            const std::vector<Case>& cases, const Figure& figure) {
  experiments::Table table{title, {"input", "fixes"}, {}};
  for (const NamedMatcher& matcher : all) table.heading.emplace_back(matcher.name);
  for (const Case& c : cases) {
    experiments::Row& row = table.rows.emplace_back(
        experiments::Row{c.name, std::to_string(c.scores[0].score.all.fixes)});
    for (const Scores& s : c.scores) row.push_back(figure(s));
  }
  return table;
}

int match_experiment(const MatchExperimentOptions& options) {
  const mapmatch::RoadNetwork network(mapmatch::open_network(options.map));
  const mapmatch::RuleBases rules = options.rule_bases();
  const auto all = matchers(network, rules, options.parameters(), options.beta);
  const std::vector<Case> cases = run_all(options, network, all);
  const auto on_a_road = [](const Scores& s) { return s.score.all.matched > 0; };
  if (std::none_of(cases.begin(), cases.end(), [&](const Case& c) {
        return std::any_of(c.scores.begin(), c.scores.end(), on_a_road);
      })) {
    throw std::runtime_error("no fix of the drives is on a road of " + options.map.string() +
                             ": is it the map of this place?");
  }
  using experiments::number;
  std::cout << as_text(table_of("All fixes: % on the right way", all, cases, [](const Scores& s) {
    return number(100.0 * s.score.all.share(), 2);
  })) << as_text(table_of("conf = 1: % on the right way", all, cases, [](const Scores& s) {
    return number(100.0 * s.score.certain.share(), 2);
  })) << as_text(table_of("Time, us a fix", all, cases, [](const Scores& s) {
    return number(1e6 * s.seconds / static_cast<double>(std::max<std::size_t>(1, s.fixes)), 1);
  }));
  experiments::Table routes{
      "Route, by the fixes of 10 s", {"input", "m", "right %", "too much %"}, {}};
  for (const Case& c : cases) {
    routes.rows.push_back({c.name, number(c.route.driven, 0),
                           number(100.0 * c.route.right_share(), 2),
                           number(100.0 * c.route.too_much_share(), 2)});
  }
  std::cout << as_text(routes);
  nlohmann::json json;
  match::Reliability reliability;
  const std::size_t step = options.each ? options.sequences.size() + 1 : 1;
  for (std::size_t c = step - 1; c < cases.size(); c += step) {  // the pooled ones
    reliability += cases[c].scores[0].score.reliability;
    for (std::size_t m = 0; m < all.size(); ++m)
      json[cases[c].name][all[m].name] = match::to_json(cases[c].scores[m].score);
  }
  std::cout << "ours, all conditions:\n" << match::to_text(reliability);
  if (!options.json.empty()) write_json_file(options.json, json);
  return 0;
}

}  // namespace

void add_match_experiment(CLI::App& experiment, Command& command) {
  auto options = std::make_shared<MatchExperimentOptions>();
  CLI::App* sub = experiment.add_subcommand(
      "match",
      "Map matching at once, 3 and 10 s later and with the rules alone, against labels of the "
      "links driven; beside the nearest segment, topological weights, the error ellipse and a "
      "hidden Markov model. Without noise, with white and with Gauss-Markov noise, at 1 and 10 Hz");
  add_recorded_drive_options(*sub, *options, "OpenStreetMap file, or a network file");
  sub->add_option(
         "--beta", options->beta,
         "Of the hidden Markov model: mean difference of driven distance and straight line, "
         "m")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  sub->add_flag("--each", options->each, "A line for each sequence, too");
  sub->add_option("--json", options->json, "Write the figures to this file as JSON")
      ->check(writable_file());
  sub->callback(
      [options, &command] { command = [options] { return match_experiment(*options); }; });
}

}  // namespace maploop::tools
