#include "tools/experiment/ppp_map_experiment.h"

#include <algorithm>
#include <map>
#include <set>

#include "tools/match/map_faults.h"

namespace maploop::experiments {
namespace {

struct WrongPppMap {
  std::string name;
  mapmatch::NetworkData data;
};

// Ways by how long they were driven, the longest first.
std::vector<std::int64_t> driven_ways(const PppDrive& drive) {
  std::map<std::int64_t, int> seconds;
  for (const auto& [second, way] : drive.driven) {
    if (way) ++seconds[*way];
  }
  std::vector<std::int64_t> ways;
  for (const auto& [way, count] : seconds) ways.push_back(way);
  std::sort(ways.begin(), ways.end(),
            [&](std::int64_t a, std::int64_t b) { return seconds[a] > seconds[b]; });
  return ways;
}

std::vector<WrongPppMap> maps_of(const PppDrive& drive) {
  const mapmatch::NetworkData right = mapmatch::build_network(drive.map);
  std::vector<WrongPppMap> maps{{"map as it is", right}};
  if (drive.driven.empty()) return maps;  // a made drive's map is wrong already
  constexpr double length = 300.0;        // m
  for (const std::uint64_t seed : {1, 2, 3}) {
    maps.push_back(
        {"bent by 2 m, seed " + std::to_string(seed), match::bent(right, 2.0, length, seed)});
  }
  const auto shift = [&](double east, double north) {
    maps.push_back({"shifted by " + number(east, 0) + ", " + number(north, 0) + " m",
                    match::shifted(right, {east, north})});
  };
  for (const double metres : {2.0, 10.0}) {
    shift(metres, 0.0);
    shift(-metres, 0.0);
    shift(0.0, metres);
    shift(0.0, -metres);
  }
  const std::vector<std::int64_t> ways = driven_ways(drive);
  const std::set<std::int64_t> all(ways.begin(), ways.end());
  maps.push_back({"a road 8 m beside each that is driven",
                  mapmatch::build_network(match::with_parallels(drive.map, all, 8.0))});
  mapmatch::MapExtract only = match::with_parallels(drive.map, all, 8.0);
  std::erase_if(only.ways, [&](const mapmatch::MapWay& w) { return all.contains(w.road.way_id); });
  maps.push_back({"that road instead of each", mapmatch::build_network(only)});
  for (std::size_t i = 0; i < std::min<std::size_t>(3, ways.size()); ++i) {
    maps.push_back(
        {"without way " + std::to_string(ways[i]), match::without_way(drive.map, ways[i])});
  }
  return maps;
}

std::vector<PppCase> parts_of(double seconds, const PppMapOptions& options, double length,
                              double blocked_from, double blocked_for) {
  std::vector<PppCase> cases;
  for (int i = 0; i < options.starts; ++i) {
    const double last = std::max(0.0, seconds - length);
    const double start = options.starts > 1 ? last * i / (options.starts - 1) : 0.0;
    if (start + length > seconds + 1.0) continue;
    cases.push_back({start, length, blocked_from, blocked_for});
  }
  return cases;
}

class PppComparison {
 public:
  PppComparison(const PppDrive& drive, const mapmatch::RuleBases& rules,
                const PppMapOptions& options)
      : drive_(drive), rules_(rules), options_(options) {
    const auto& epochs = drive.files.observations[0].epochs;
    seconds_ = to_seconds(epochs.back().time - epochs.front().time) + 1.0;
  }

  std::vector<Part> run(const mapmatch::NetworkData& map, const std::vector<PppCase>& cases,
                        double lowest = 0.0) const {
    ppp::SetupOptions setup_options = options_.setup;
    if (lowest > 0.0) setup_options.parameters.elevation_mask = lowest;
    const ppp::PppSetup setup(drive_.files, setup_options);
    const mapmatch::RoadNetwork network(map);
    const PppSetting setting{&setup,         drive_.truth.get(), &network,         &rules_,
                             &drive_.driven, options_.match,     options_.feedback};
    std::vector<Part> parts;
    for (const PppCase& c : cases) parts.push_back(run_case(setting, c));
    return parts;
  }

  double seconds() const { return seconds_; }

 private:
  const PppDrive& drive_;
  const mapmatch::RuleBases& rules_;
  const PppMapOptions& options_;
  double seconds_ = 0.0;
};

void append(std::vector<PppMapResult>& results, const std::string& group, const std::string& name,
            double from, std::vector<Part> parts) {
  const auto known = std::find_if(results.begin(), results.end(), [&](const PppMapResult& r) {
    return r.group == group && r.name == name;
  });
  PppMapResult& result =
      known != results.end() ? *known : results.emplace_back(PppMapResult{group, name, {}, from});
  for (Part& part : parts) result.parts.push_back(std::move(part));
}

}  // namespace

std::vector<PppMapResult> compare_ppp_map(const std::vector<PppDrive>& drives,
                                          const mapmatch::RuleBases& rules,
                                          const PppMapOptions& options,
                                          const std::function<void(const std::string&)>& progress) {
  std::vector<PppMapResult> results;
  for (const PppDrive& drive : drives) {
    const PppComparison comparison(drive, rules, options);
    const PppCase whole{0.0, comparison.seconds() + 1.0, 0.0, 0.0};
    for (const WrongPppMap& map : maps_of(drive)) {
      progress(drive.name + ", the whole drive, " + map.name);
      append(results, drive.group, "whole drive, " + map.name, 0.0,
             comparison.run(map.data, {whole}));
    }
    const mapmatch::NetworkData right = mapmatch::build_network(drive.map);
    progress(drive.name + ", cold starts");
    append(
        results, drive.group, "cold start", 0.0,
        comparison.run(right, parts_of(comparison.seconds(), options, options.length, 0.0, 0.0)));
    progress(drive.name + ", tunnels");
    const double behind = options.length + options.tunnel;
    append(results, drive.group, "behind a tunnel", behind,
           comparison.run(right, parts_of(comparison.seconds(), options, behind + options.length,
                                          options.length, options.tunnel)));
    progress(drive.name + ", few satellites");
    append(results, drive.group, "few satellites", 0.0,
           comparison.run(right, parts_of(comparison.seconds(), options, options.length, 0.0, 0.0),
                          options.few));
  }
  return results;
}

}  // namespace maploop::experiments
