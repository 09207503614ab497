#include "tools/experiment/map_experiment.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "estimators/fusion/outcome.h"
#include "estimators/fusion/parameter_table.h"
#include "runtime/vehicle/graph/graph.h"
#include "sensors/replay/reference_trajectory.h"
#include "tools/match/map_faults.h"

namespace maploop::experiments {
namespace {

constexpr Duration sampled_every = std::chrono::milliseconds(100);

double tracks_end(const std::string& sequence) {
  const auto known = std::find_if(sequences.begin(), sequences.end(),
                                  [&](const Sequence& s) { return s.name == sequence; });
  return known != sequences.end() ? known->tracks_end : 0.0;
}

std::int64_t way_driven_longest(const match::Labels& labels) {
  std::map<std::int64_t, std::size_t> rows;
  for (const auto& [row, label] : labels) ++rows[label.way_id];
  return std::max_element(rows.begin(), rows.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

mapmatch::NetworkData with_fault(const MapSetting& setting, const std::string& fault,
                                 const match::Labels& labels) {
  const mapmatch::NetworkData& network = setting.roads->network.data();
  if (fault == "missing") return match::without_way(*setting.extract, way_driven_longest(labels));
  if (fault == "shifted 5 m") return match::shifted(network, {5.0, 0.0});
  if (fault == "shifted 10 m") return match::shifted(network, {10.0, 0.0});
  if (fault == "reversed") return match::one_way_reversed(network);
  if (fault != "parallel 12 m")
    throw std::invalid_argument("no map fault is called '" + fault + "'");
  return mapmatch::build_network(
      match::with_parallels(*setting.extract, match::driven_ways(labels), 12.0));
}

// How often the filter refused something for this reason.
std::uint64_t refused(const Health& health, std::string_view reason) {
  for (const RefusalCount& r : health.refusals) {
    if (r.stage == vehicle::stages::fusion.name && r.reason == reason) return r.count;
  }
  return 0;
}

// What the vehicle says at each of its ticks.
struct Ticks {
  std::vector<NavState> states;
  std::map<Time, match::TimedMatch> matches;
  std::map<Time, FeedbackReason> feedbacks;

  vehicle::Observer observer() {
    vehicle::Observer o;
    o.nav_state = [this](const NavState& state) {
      if (state.status != NavStatus::uninitialized &&
          state.stamp.time_since_epoch() % sampled_every == Duration::zero())
        states.push_back(state);
    };
    o.map_match = [this](const MapMatch& match) {
      matches[match.stamp] = match::timed_match(match);
    };
    o.map_feedback = [this](const MapFeedback& back) { feedbacks[back.stamp] = back.reason; };
    return o;
  }
};

// The errors of a state against the pose of the body.
MapSample sample_of(const NavState& state, const Eigen::Isometry3d& pose) {
  MapSample sample;
  sample.truth = pose.translation().head<2>();
  sample.error = state.position_enu.head<2>() - sample.truth;
  sample.azimuth = attitude_from_rotation(pose.rotation()).azimuth;
  sample.azimuth_error = wrap_angle(state.attitude.azimuth - sample.azimuth);
  const Eigen::Matrix2d P = state.covariance.topLeftCorner<2, 2>();
  sample.sigma = std::sqrt(P.trace());
  sample.nees = sample.error.dot(P.inverse() * sample.error);
  return sample;
}

}  // namespace

const std::vector<std::string>& map_faults() {
  static const std::vector<std::string> names{"missing", "shifted 5 m", "shifted 10 m", "reversed",
                                              "parallel 12 m"};
  return names;
}

std::vector<MapCase> map_cases(const MapCases& wanted) {
  MapCase first;
  first.speed_scale = wanted.speed_scale - 1.0;
  std::vector<MapCase> cases{first};
  // Replaces each case by one for each value, which `set` sets in it.
  const auto with = [&cases](const auto& values, const auto& set) {
    std::vector<MapCase> more;
    for (const MapCase& c : cases)
      for (const auto& value : values) set(more.emplace_back(c), value);
    cases = std::move(more);
  };
  std::vector<std::string> faults{""};
  faults.insert(faults.end(), wanted.faults.begin(), wanted.faults.end());
  std::vector<std::int64_t> seeds(static_cast<std::size_t>(wanted.seeds));
  std::iota(seeds.begin(), seeds.end(), 1);
  with(wanted.configurations, [](MapCase& c, const auto& value) { c.configuration = value; });
  with(wanted.units, [](MapCase& c, const auto& value) { c.mems = value == "mems"; });
  with(wanted.outages, [](MapCase& c, const auto& value) { c.outages = value; });
  with(wanted.sequences, [](MapCase& c, const auto& value) { c.sequence = value; });
  with(faults, [](MapCase& c, const auto& value) { c.fault = value; });
  with(wanted.modes, [](MapCase& c, MapMode value) { c.mode = value; });
  with(seeds, [](MapCase& c, std::int64_t value) { c.seed = value; });
  const auto needs_tracks = [&](const MapCase& c) {
    return c.configuration.find("VO") != std::string::npos && !wanted.poses;
  };
  for (MapCase& c : cases) c.end = needs_tracks(c) ? tracks_end(c.sequence) : 0.0;
  std::erase_if(cases, [&](const MapCase& c) {
    return (needs_tracks(c) && c.end == 0.0) || (c.mode == MapMode::none && !c.fault.empty());
  });
  return cases;
}

const fusion_score::Errors& without_gnss(const MapResult& result) {
  return result.score.outages.empty() ? result.score.whole : result.score.outages.front().errors;
}

MapResult run(const MapSetting& setting, const MapCase& setup) {
  vehicle::VehicleConfig config = config_of(setting.config, setup);
  config.map.mode = setup.mode;
  const match::Labels labels =
      match::read_labels(setting.folder / "labels" / (setup.sequence + ".csv.gz"));
  std::shared_ptr<const vehicle::RoadMap> roads;
  if (setup.mode != MapMode::none) roads = setting.roads;
  if (roads && !setup.fault.empty()) {
    roads = std::make_shared<const vehicle::RoadMap>(vehicle::RoadMap{
        mapmatch::RoadNetwork(with_fault(setting, setup.fault, labels)), setting.roads->rules});
  }
  Ticks ticks;
  const SequenceRun run =
      run_sequence(setting.folder, setup, config, ticks.observer(), std::move(roads));

  MapResult result;
  result.setup = setup;
  result.score = run.score;
  if (setup.fault == "missing") result.missing = way_driven_longest(labels);
  const Health& health = run.report.health;
  result.gated = refused(health, to_string(fusion::Reason::line_gate)) +
                 refused(health, to_string(fusion::Reason::link_azimuth_gate));
  result.restorations = refused(health, "undone: the map had led astray");
  const vehicle::Recording& recording = run.recording;
  const std::vector<Time>& frames = recording.driven_links.value().stamps;
  const Time begin =
      recording.outages.empty() ? recording.first_stamp : recording.outages.front().begin;
  std::vector<match::TimedMatch> matches;
  for (const auto& [stamp, match] : ticks.matches) {
    if (stamp >= begin) matches.push_back(match);
  }
  result.match = match::score_matches(matches, frames, labels);
  if (ticks.states.empty()) return result;
  result.origin = ticks.states.front().origin;
  const sensors::ReferenceTrajectory truth(run.reference, LocalFrame(result.origin));
  for (const NavState& state : ticks.states) {
    const auto back = ticks.feedbacks.find(state.stamp);
    if (back != ticks.feedbacks.end()) ++result.reasons[static_cast<std::size_t>(back->second)];
    const auto pose = truth.pose(state.stamp);
    if (!pose || truth.accuracy(state.stamp) > fusion_score::worst_reference) continue;
    MapSample sample = sample_of(state, *pose);
    if (back != ticks.feedbacks.end()) sample.reason = back->second;
    if (const auto match = ticks.matches.find(state.stamp); match != ticks.matches.end())
      sample.probability = match->second.matched.p_link;
    if (const auto frame = match::frame_at(state.stamp, frames); frame && result.missing != 0) {
      const auto label = labels.find(*frame);
      sample.on_missing = label != labels.end() && label->second.way_id == result.missing;
    }
    sample.time = to_seconds(state.stamp - recording.first_stamp);
    result.samples.push_back(sample);
  }
  return result;
}

}  // namespace maploop::experiments
