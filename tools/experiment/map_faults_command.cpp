// maploop experiment map-faults: map matching of recorded drives on wrong maps.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "mapmatch/osm_reader.h"
#include "msgs/frames.h"
#include "tools/command/recorded_drive_options.h"
#include "tools/experiment/experiments.h"
#include "tools/experiment/table.h"
#include "tools/match/map_faults.h"

namespace maploop::tools {
namespace {

using match::RecordedDrive;

// A map, the way that is wrong in it, and the way that it lacks.
struct WrongMap {
  const char* fault;
  mapmatch::RoadNetwork network;
  std::int64_t way = 0;
  std::int64_t missing = 0;
  std::size_t seed = 0;  // of the drawn error; 0: none is drawn
};

struct FaultScores {
  std::size_t cases = 0, over = 0, late = 0;
  double longest = 0.0, recovery = 0.0;
  double p_sum = 0.0;
  std::size_t fixes = 0, said = 0, sure = 0;
  std::size_t found = 0, others = 0;  // doubts
  bool has_way = false;               // whether there is a wrong way to be found
  std::string worst;

  void add(const match::FaultScore& score, const match::DoubtScore& doubts,
           const RecordedDrive& drive, std::int64_t way, std::size_t seed) {
    ++cases;
    found += doubts.found ? 1 : 0;
    others += doubts.others;
    has_way = has_way || way != 0;
    over += score.longest_sure_wrong > 3.0 ? 1 : 0;
    late += score.recovery > 150.0 ? 1 : 0;
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
    return {
        std::to_string(cases),
        number(longest, 1),
        std::to_string(over),
        number(recovery, 0),
        std::to_string(late),
        of_fixes(said, 1),
        of_fixes(sure, 2),
        fixes == 0 ? "-" : number(p_sum / answers, 2),
        has_way ? number(100.0 * static_cast<double>(found) / static_cast<double>(cases), 1) : "-",
        number(static_cast<double>(others) / static_cast<double>(cases), 2),
        worst};
  }
};

Eigen::Vector2d heading(double azimuth) {
  return {std::sin(azimuth), std::cos(azimuth)};
}

std::vector<WrongMap> wrong_maps(const mapmatch::MapExtract& map,
                                 const mapmatch::NetworkData& network, const RecordedDrive& drive,
                                 int seeds) {
  std::vector<WrongMap> maps;
  const auto add = [&](const char* fault, mapmatch::NetworkData data) -> WrongMap& {
    maps.push_back({fault, mapmatch::RoadNetwork(std::move(data), RoadSide::right)});
    return maps.back();
  };
  add("as it is", network);
  for (const double azimuth : {0.0, 90.0, 180.0, 270.0})
    add("shifted by 5 m", match::shifted(network, 5.0 * heading(radians(azimuth))));
  const mapmatch::RoadNetwork right(network);
  for (int seed = 1; seed <= seeds; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const auto draw = [&](double least, double most) {
      return least + (most - least) * std::generate_canonical<double, 53>(random);
    };
    const Eigen::Vector2d shift = draw(5.0, 20.0) * heading(draw(0.0, radians(360.0)));
    add("shifted by 5 to 20 m", match::shifted(network, shift)).seed =
        static_cast<std::size_t>(seed);
    const double angle = radians(draw(-1.0, 1.0));
    const Eigen::Vector2d start = right.to_local(drive.track.front().position);
    add("turned by up to 1 degree", match::turned(network, start, angle)).seed =
        static_cast<std::size_t>(seed);
  }
  add("one-way reversed", match::one_way_reversed(network));
  const auto divided =
      mapmatch::build_network(match::with_opposite_carriageways(map, drive.labels, 12.0));
  add("opposite carriageways", divided);
  add("opposite carriageways reversed", match::one_way_reversed(divided));
  for (const std::int64_t way : match::driven_ways(drive.labels)) {
    add("a driven way's direction wrong",
        mapmatch::build_network(match::direction_wrong(map, drive.labels, way)))
        .way = way;
    WrongMap& less = add("a driven way missing", match::without_way(map, way));
    less.way = less.missing = way;
  }
  return maps;
}

int fault_experiment(const RecordedDriveOptions& options) {
  const mapmatch::MapExtract map = mapmatch::read_osm(options.map);
  const mapmatch::NetworkData network = mapmatch::build_network(map);
  const mapmatch::RuleBases rules = options.rule_bases();
  const mapmatch::MatchParameters parameters = options.parameters();
  const auto conditions = match::input_conditions();
  experiments::Groups<std::vector<FaultScores>> scores;  // of each fault, for each condition
  for (const std::string& name : options.sequences) {
    std::cerr << "\rsequence " << name << std::flush;
    const RecordedDrive drive = match::read_recorded_drive(options.data, name);
    const auto maps = wrong_maps(map, network, drive, options.seeds);
    for (std::size_t c = 0; c < conditions.size(); ++c) {
      const auto tracks = conditions[c].realizations(drive, options.seeds);
      for (std::size_t i = 0; i < tracks.size(); ++i) {
        for (const WrongMap& wrong : maps) {
          if (wrong.seed > 0 && tracks.size() > 1 && wrong.seed != i + 1) continue;
          mapmatch::Matcher matcher(wrong.network, rules, parameters);
          std::vector<MapDoubt> doubts;
          const auto matched = match::match_track(matcher, tracks[i].track, {.doubts = &doubts});
          const match::FaultScore score =
              match::score_fault(matched, tracks[i], drive.labels, wrong.missing);
          const match::DoubtScore doubted =
              match::score_doubts(doubts, tracks[i], drive.labels, wrong.way, wrong.missing != 0);
          auto& of_fault = scores[{wrong.fault}];
          of_fault.resize(conditions.size() + 1);
          for (const std::size_t row : {c, conditions.size()})
            of_fault[row].add(score, doubted, drive, wrong.way, i + 1);
        }
      }
    }
  }
  experiments::Table table{"Map matching on wrong maps",
                           {"map", "fixes", "drives", "longest s", "> 3 s", "recovery m", "> 150",
                            "said %", "sure %", "P", "found %", "other doubts", "longest of"},
                           {}};
  for (const auto& [fault, of_fault] : scores) {
    for (std::size_t c = 0; c < of_fault.size(); ++c) {
      experiments::Row& row = table.rows.emplace_back(fault);
      row.push_back(c < conditions.size() ? conditions[c].name : "all");
      for (const std::string& cell : of_fault[c].cells()) row.push_back(cell);
    }
  }
  std::cerr << '\n';
  std::cout << as_text(table)
            << "longest: a wrong link with P above 0.9, without a break; recovery: distance driven "
               "without the right link where the map has it\non the missing way: share of fixes "
               "with a link (which is wrong), with P above 0.9, and its mean P\n"
               "found: drives whose doubts name the wrong way; other doubts: a drive, of the rest "
               "of the map\n";
  return 0;
}

}  // namespace

void add_map_fault_experiment(CLI::App& experiment, Command& command) {
  auto options = std::make_shared<RecordedDriveOptions>();
  CLI::App* sub = experiment.add_subcommand(
      "map-faults",
      "Map matching on wrong maps: shifted, turned, one-way streets and opposite carriageways "
      "reversed, each driven way's direction wrong, each driven way missing; without noise, with "
      "white and with Gauss-Markov noise, at 1 and 10 Hz");
  add_recorded_drive_options(*sub, *options, "OpenStreetMap file");
  sub->callback(
      [options, &command] { command = [options] { return fault_experiment(*options); }; });
}

}  // namespace maploop::tools
