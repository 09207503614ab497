// maploop experiment map-faults: map matching of recorded drives on wrong maps.
#include <fmt/format.h>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "mapmatch/network_file.h"
#include "tools/command/recorded_drive_options.h"
#include "tools/experiment/experiments.h"
#include "tools/match/map_faults.h"
#include "tools/match/parameter_settings.h"
#include "tools/match/recorded_drives.h"

namespace maploop::tools {
namespace {

using match::FaultScore;
using match::InputCondition;
using match::RecordedDrive;

// A map, and the way that it lacks.
struct WrongMap {
  std::unique_ptr<mapmatch::RoadNetwork> network;
  std::int64_t missing = 0;
};

enum Fault { none, shift, reversed, missing, fault_count };
constexpr const char* fault_names[] = {"as it is", "shifted by 5 m", "one-way reversed",
                                       "a driven way missing"};

struct FaultRow {
  std::size_t cases = 0, over = 0, late = 0;
  double longest = 0.0, recovery = 0.0;
  double p_sum = 0.0;
  std::size_t fixes = 0, said = 0, sure = 0;
  std::string worst;

  void add(const FaultScore& score, const RecordedDrive& drive, std::int64_t way, int seed) {
    ++cases;
    over += score.longest_sure_wrong > 3.0 ? 1 : 0;
    late += score.recovery > 50.0 ? 1 : 0;
    recovery = std::max(recovery, score.recovery);
    fixes += score.missing_fixes;
    said += score.missing_said;
    sure += score.missing_sure;
    p_sum += score.missing_p_sum;
    if (score.longest_sure_wrong <= longest) return;
    longest = score.longest_sure_wrong;
    worst = fmt::format("{} at {:.0f} s, seed {}", drive.name, score.worst_at, seed);
    if (way) worst += ", way " + std::to_string(way);
  }
};

void print(const char* fault, const char* condition, const FaultRow& row) {
  std::printf("%-22s %-26s %6zu %9.1f %5zu %10.0f %5zu", fault, condition, row.cases, row.longest,
              row.over, row.recovery, row.late);
  if (row.fixes > 0)
    std::printf("  %5.1f %5.2f %5.2f",
                100.0 * static_cast<double>(row.said) / static_cast<double>(row.fixes),
                100.0 * static_cast<double>(row.sure) / static_cast<double>(row.fixes),
                row.p_sum / static_cast<double>(std::max<std::size_t>(1, row.said)));
  std::printf("  %s\n", row.worst.c_str());
  std::fflush(stdout);
}

std::vector<std::vector<WrongMap>> wrong_maps(const mapmatch::MapExtract& map,
                                              const mapmatch::NetworkData& network,
                                              const RecordedDrive& drive) {
  std::vector<std::vector<WrongMap>> maps(fault_count);
  const auto add = [&](Fault fault, mapmatch::NetworkData data, std::int64_t way = 0) {
    maps[fault].push_back({std::make_unique<mapmatch::RoadNetwork>(std::move(data)), way});
  };
  add(none, network);
  for (const Eigen::Vector2d& metres : {Eigen::Vector2d(5, 0), Eigen::Vector2d(-5, 0),
                                        Eigen::Vector2d(0, 5), Eigen::Vector2d(0, -5)})
    add(shift, match::shifted(network, metres));
  add(reversed, match::one_way_reversed(network));
  std::set<std::int64_t> driven;
  for (const auto& [row, label] : drive.labels) driven.insert(label.way_id);
  for (const std::int64_t way : driven) add(missing, match::without_way(map, way), way);
  return maps;
}

int fault_experiment(const RecordedDriveOptions& options) {
  const mapmatch::MapExtract map = mapmatch::read_osm(options.map);
  const mapmatch::NetworkData network = mapmatch::build_network(map);
  const mapmatch::RuleBases rules = mapmatch::read_rule_bases(mapmatch::default_rules());
  const mapmatch::MatchParameters parameters = match::parameters_with(options.set);
  const auto& conditions = match::input_conditions();
  std::vector<std::vector<FaultRow>> rows(fault_count, std::vector<FaultRow>(conditions.size()));
  for (const std::string& name : options.sequences) {
    const RecordedDrive drive = match::read_recorded_drive(options.data, name);
    const auto maps = wrong_maps(map, network, drive);
    for (std::size_t c = 0; c < conditions.size(); ++c) {
      for (int seed = 1; seed <= conditions[c].realizations(options.seeds); ++seed) {
        const auto [track, track_rows] = match::noisy_track(drive, conditions[c], seed);
        for (std::size_t fault = 0; fault < maps.size(); ++fault) {
          for (const WrongMap& wrong : maps[fault]) {
            mapmatch::Matcher matcher(*wrong.network, rules, parameters);
            rows[fault][c].add(match::score_fault(match::match_track(matcher, track), track,
                                                  track_rows, drive.labels, wrong.missing),
                               drive, wrong.missing, seed);
          }
        }
      }
    }
  }
  std::printf("%-22s %-26s %6s %9s %5s %10s %5s  %5s %5s %5s\n", "map", "fixes", "drives",
              "longest s", "> 3 s", "recovery m", "> 50", "said%", "sure%", "P");
  for (std::size_t fault = 0; fault < rows.size(); ++fault)
    for (std::size_t c = 0; c < conditions.size(); ++c)
      print(fault_names[fault], conditions[c].name, rows[fault][c]);
  std::cout
      << "longest: a wrong link with P above 0.9, without a break; recovery: from where the map "
         "is right again to the right link\non the missing way: share of fixes with a link "
         "(which is wrong), with P above 0.9, and its mean P\n";
  return 0;
}

}  // namespace

void add_map_fault_experiment(CLI::App& experiment, Command& command) {
  auto options = std::make_shared<RecordedDriveOptions>();
  CLI::App* sub = experiment.add_subcommand(
      "map-faults",
      "Map matching on wrong maps: shifted, one-way streets reversed, each driven way missing; "
      "without noise, with white and with Gauss-Markov noise, at 1 and 10 Hz");
  add_recorded_drive_options(*sub, *options, "OpenStreetMap file");
  sub->callback(
      [options, &command] { command = [options] { return fault_experiment(*options); }; });
}

}  // namespace maploop::tools
