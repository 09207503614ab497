// maploop experiment match | map-faults: map matching on recorded drives, with made errors.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "mapmatch/network_file.h"
#include "msgs/frames.h"
#include "tools/evaluation/text_file.h"
#include "tools/experiments.h"
#include "tools/json_output.h"
#include "tools/match/csv_track.h"
#include "tools/match/map_faults.h"
#include "tools/match/match_score.h"
#include "tools/match/parameter_settings.h"
#include "tools/match/score_output.h"
#include "tools/match/track_noise.h"
#include "tools/option_checks.h"

namespace maploop::tools {
namespace {

struct MatchExperimentOptions {
  std::filesystem::path map, data, json;
  std::vector<std::string> sequences{"00", "01", "02", "03", "04", "06", "08", "10"};
  std::vector<std::string> set;
  int seeds = 3;
  bool each = false;
};

struct Sequence {
  std::string name;
  match::Track track;
  std::map<std::size_t, match::Label> labels;
};

struct Condition {
  const char* name;
  double interval;  // s
  match::TrackNoise noise;
};

const std::vector<Condition>& conditions() {
  const auto noisy = [](double white, double markov) {
    return match::TrackNoise{white, markov, 30.0, 0.2, radians(3.0), 1};
  };
  static const std::vector<Condition> all{
      {"noise-free, 1 Hz", 1.0, {}},
      {"noise-free, 10 Hz", 0.0, {}},
      {"white 5 m, 1 Hz", 1.0, noisy(5, 0)},
      {"white 10 m, 1 Hz", 1.0, noisy(10, 0)},
      {"white 15 m, 1 Hz", 1.0, noisy(15, 0)},
      {"white 5 m, 10 Hz", 0.0, noisy(5, 0)},
      {"white 10 m, 10 Hz", 0.0, noisy(10, 0)},
      {"white 15 m, 10 Hz", 0.0, noisy(15, 0)},
      {"Gauss-Markov 5 m, 1 Hz", 1.0, noisy(0, 5)},
      {"Gauss-Markov 10 m, 1 Hz", 1.0, noisy(0, 10)},
      {"Gauss-Markov 15 m, 1 Hz", 1.0, noisy(0, 15)},
      {"Gauss-Markov 5 m, 10 Hz", 0.0, noisy(0, 5)},
      {"Gauss-Markov 10 m, 10 Hz", 0.0, noisy(0, 10)},
      {"Gauss-Markov 15 m, 10 Hz", 0.0, noisy(0, 15)},
  };
  return all;
}

Sequence read_sequence(const std::filesystem::path& data, const std::string& name) {
  const auto track = data / "oxts" / (name + ".csv.gz");
  return {name, match::parse_csv_track(evaluation::read_text(track), track.string(), {}),
          match::read_labels(data / "labels" / (name + ".csv.gz"))};
}

struct Scores {
  match::MatchScore ours, baseline;
  double seconds = 0.0;
  std::size_t fixes = 0;
};

void run(const mapmatch::RoadNetwork& network, const mapmatch::RuleBases& rules,
         const mapmatch::MatchParameters& parameters, const Sequence& sequence,
         const Condition& condition, int seeds, Scores& scores) {
  const bool noisy = condition.noise.white + condition.noise.markov > 0.0;
  for (int seed = 1; seed <= (noisy ? seeds : 1); ++seed) {
    match::TrackNoise noise = condition.noise;
    noise.seed = static_cast<std::uint64_t>(seed);
    std::vector<std::size_t> rows;
    const match::Track track = match::with_noise(sequence.track, condition.interval, noise, &rows);
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
  std::vector<Sequence> sequences;
  const match::SegmentLinks links(network);
  for (const std::string& name : options.sequences) {
    sequences.push_back(read_sequence(options.data, name));
    links.look_up(sequences.back().labels);
  }
  std::printf("%-26s %7s  %-13s  %-13s  %-13s  %-6s  %s\n", "input", "fixes", "all frames %",
              "conf = 1 %", "coverage %", "wrong", "us a fix");
  std::printf("%-26s %7s  %6s %6s  %6s %6s  %6s %6s  %6s\n", "", "", "ours", "base", "ours", "base",
              "ours", "base", "/base");
  nlohmann::json json;
  match::Reliability reliability;
  for (const Condition& condition : conditions()) {
    Scores pooled;
    for (const Sequence& sequence : sequences) {
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

struct FaultRow {
  std::size_t cases = 0, over = 0, late = 0;
  double longest = 0.0, recovery = 0.0;
  std::string worst;
};

// The matcher on one wrong map, along one drive.
void run_fault(const mapmatch::NetworkData& wrong, const mapmatch::RuleBases& rules,
               const mapmatch::MatchParameters& parameters, const Sequence& sequence,
               std::int64_t missing, FaultRow& row) {
  const mapmatch::RoadNetwork network(wrong);
  mapmatch::Matcher matcher(network, rules, parameters);
  std::vector<std::size_t> rows(sequence.track.size());
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = i;
  const match::FaultScore score = match::score_fault(
      match::match_track(matcher, sequence.track), sequence.track, rows, sequence.labels, missing);
  ++row.cases;
  row.over += score.longest_sure_wrong > 3.0 ? 1 : 0;
  row.late += score.recovery > 50.0 ? 1 : 0;
  row.recovery = std::max(row.recovery, score.recovery);
  if (score.longest_sure_wrong > row.longest) {
    row.longest = score.longest_sure_wrong;
    char at[32];
    std::snprintf(at, sizeof at, " at %.0f s", score.worst_at);
    row.worst = sequence.name + at + (missing ? ", way " + std::to_string(missing) : "");
  }
}

void print_fault(const char* name, const FaultRow& row) {
  std::printf("%-28s %6zu %10.1f %6zu %12.0f %6zu  %s\n", name, row.cases, row.longest, row.over,
              row.recovery, row.late, row.worst.c_str());
  std::fflush(stdout);
}

int fault_experiment(const MatchExperimentOptions& options) {
  const mapmatch::MapExtract map = mapmatch::read_osm(options.map);
  const mapmatch::NetworkData network = mapmatch::build_network(map);
  const mapmatch::RuleBases rules = mapmatch::read_rule_bases(mapmatch::default_rules());
  const mapmatch::MatchParameters parameters = match::parameters_with(options.set);
  FaultRow none, shift, reversed, missing;
  for (const std::string& name : options.sequences) {
    const Sequence sequence = read_sequence(options.data, name);
    run_fault(network, rules, parameters, sequence, 0, none);
    for (const Eigen::Vector2d& metres : {Eigen::Vector2d(5, 0), Eigen::Vector2d(-5, 0),
                                          Eigen::Vector2d(0, 5), Eigen::Vector2d(0, -5)})
      run_fault(match::shifted(network, metres), rules, parameters, sequence, 0, shift);
    run_fault(match::one_way_reversed(network), rules, parameters, sequence, 0, reversed);
    std::set<std::int64_t> driven;
    for (const auto& [row, label] : sequence.labels) driven.insert(label.way_id);
    for (const std::int64_t way : driven)
      run_fault(match::without_way(map, way), rules, parameters, sequence, way, missing);
  }
  std::printf("%-28s %6s %10s %6s %12s %6s\n", "map", "drives", "longest s", "> 3 s", "recovery m",
              "> 50 m");
  print_fault("as it is", none);
  print_fault("shifted by 5 m", shift);
  print_fault("one-way streets reversed", reversed);
  print_fault("one driven way missing", missing);
  std::cout << "longest: a wrong link with P above 0.9, without a break; recovery: from where the "
               "map is right again\n";
  return 0;
}

}  // namespace

void add_match_experiments(CLI::App& experiment, Command& command) {
  auto options = std::make_shared<MatchExperimentOptions>();
  CLI::App* sub = experiment.add_subcommand(
      "match",
      "Map matching against labels of the links driven, beside the nearest segment with an azimuth "
      "gate: without noise, with white and with Gauss-Markov noise, at 1 and 10 Hz");
  sub->add_option("MAP", options->map, "OpenStreetMap file, or a network file")->required();
  sub->add_option("DATA", options->data, "Folder with oxts/NN.csv.gz and labels/NN.csv.gz")
      ->required()
      ->check(existing_folder());
  sub->add_option("--sequences", options->sequences, "Which of them")->delimiter(',');
  sub->add_option("--seeds", options->seeds, "Realizations of each noise")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  sub->add_option("--set", options->set, "NAME=VALUE of a parameter (mapmatch/match_parameters.h)");
  sub->add_flag("--each", options->each, "A line for each sequence, too");
  sub->add_option("--json", options->json, "Write the figures to this file as JSON")
      ->check(writable_file());
  sub->callback(
      [options, &command] { command = [options] { return match_experiment(*options); }; });

  sub = experiment.add_subcommand(
      "map-faults",
      "Map matching on wrong maps: shifted, one-way streets reversed, each driven way "
      "missing; fixes without noise, 10 Hz");
  sub->add_option("MAP", options->map, "OpenStreetMap file")->required();
  sub->add_option("DATA", options->data, "Folder with oxts/NN.csv.gz and labels/NN.csv.gz")
      ->required()
      ->check(existing_folder());
  sub->add_option("--sequences", options->sequences, "Which of them")->delimiter(',');
  sub->add_option("--set", options->set, "NAME=VALUE of a parameter (mapmatch/match_parameters.h)");
  sub->callback(
      [options, &command] { command = [options] { return fault_experiment(*options); }; });
}

}  // namespace maploop::tools
