// maploop experiment map-faults: map matching of recorded drives on wrong maps.
#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "mapmatch/osm_reader.h"
#include "tools/command/recorded_drive_options.h"
#include "tools/experiment/experiments.h"
#include "tools/experiment/table.h"
#include "tools/match/map_faults.h"
#include "tools/match/parameter_settings.h"

namespace maploop::tools {
namespace {

using match::RecordedDrive;

// A map, and the way that it lacks.
struct WrongMap {
  const char* fault;
  mapmatch::RoadNetwork network;
  std::int64_t missing = 0;
};

struct FaultScores {
  std::size_t cases = 0, over = 0, late = 0;
  double longest = 0.0, recovery = 0.0;
  double p_sum = 0.0;
  std::size_t fixes = 0, said = 0, sure = 0;
  std::string worst;

  void add(const match::FaultScore& score, const RecordedDrive& drive, std::int64_t way,
           std::size_t seed) {
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

  experiments::Row cells() const {
    using experiments::number;
    const auto of_fixes = [&](std::size_t count, int digits) {
      if (fixes == 0) return std::string("-");
      return number(100.0 * static_cast<double>(count) / static_cast<double>(fixes), digits);
    };
    const auto answers = static_cast<double>(std::max<std::size_t>(1, said));
    return {std::to_string(cases),
            number(longest, 1),
            std::to_string(over),
            number(recovery, 0),
            std::to_string(late),
            of_fixes(said, 1),
            of_fixes(sure, 2),
            fixes == 0 ? "-" : number(p_sum / answers, 2),
            worst};
  }
};

std::vector<WrongMap> wrong_maps(const mapmatch::MapExtract& map,
                                 const mapmatch::NetworkData& network, const RecordedDrive& drive) {
  std::vector<WrongMap> maps;
  const auto add = [&](const char* fault, mapmatch::NetworkData data, std::int64_t way = 0) {
    maps.push_back({fault, mapmatch::RoadNetwork(std::move(data)), way});
  };
  add("as it is", network);
  for (const Eigen::Vector2d& metres : {Eigen::Vector2d(5, 0), Eigen::Vector2d(-5, 0),
                                        Eigen::Vector2d(0, 5), Eigen::Vector2d(0, -5)})
    add("shifted by 5 m", match::shifted(network, metres));
  add("one-way reversed", match::one_way_reversed(network));
  for (const std::int64_t way : match::driven_ways(drive.labels))
    add("a driven way missing", match::without_way(map, way), way);
  return maps;
}

int fault_experiment(const RecordedDriveOptions& options) {
  const mapmatch::MapExtract map = mapmatch::read_osm(options.map);
  const mapmatch::NetworkData network = mapmatch::build_network(map);
  const mapmatch::RuleBases rules = mapmatch::read_rule_bases(mapmatch::default_rules());
  mapmatch::MatchParameters parameters;
  match::apply_settings(options.set, parameters);
  const auto conditions = match::input_conditions();
  experiments::Groups<std::vector<FaultScores>> scores;  // of each fault, for each condition
  for (const std::string& name : options.sequences) {
    std::cerr << "\rsequence " << name << std::flush;
    const RecordedDrive drive = match::read_recorded_drive(options.data, name);
    const auto maps = wrong_maps(map, network, drive);
    for (std::size_t c = 0; c < conditions.size(); ++c) {
      const auto tracks = conditions[c].realizations(drive, options.seeds);
      for (std::size_t i = 0; i < tracks.size(); ++i)
        for (const WrongMap& wrong : maps) {
          mapmatch::Matcher matcher(wrong.network, rules, parameters);
          const auto matched = match::match_track(matcher, tracks[i].track);
          auto& of_fault = scores[{wrong.fault}];
          of_fault.resize(conditions.size());
          of_fault[c].add(match::score_fault(matched, tracks[i], drive.labels, wrong.missing),
                          drive, wrong.missing, i + 1);
        }
    }
  }
  experiments::Table table{"Map matching on wrong maps",
                           {"map", "fixes", "drives", "longest s", "> 3 s", "recovery m", "> 50",
                            "said %", "sure %", "P", "longest of"},
                           {}};
  for (const auto& [fault, of_fault] : scores)
    for (std::size_t c = 0; c < conditions.size(); ++c) {
      experiments::Row& row = table.rows.emplace_back(fault);
      row.push_back(conditions[c].name);
      for (const std::string& cell : of_fault[c].cells()) row.push_back(cell);
    }
  std::cerr << '\n';
  std::cout
      << as_text(table)
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
