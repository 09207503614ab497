#include "tools/experiments/map_experiment.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "estimators/fusion/guarded_filter.h"
#include "estimators/fusion/parameter_table.h"
#include "mapmatch/matcher.h"
#include "mapmatch/nav_matcher.h"
#include "mapmatch/parameter_table.h"
#include "runtime/vehicle/limited_source.h"
#include "runtime/vehicle/recording.h"
#include "sensors/replay/reference_trajectory.h"
#include "tools/match/labels.h"
#include "tools/match/map_faults.h"
#include "tools/match/parameter_settings.h"

namespace maploop::experiments {
namespace {

namespace fs = std::filesystem;

constexpr Duration tick_period = std::chrono::milliseconds(100);

// The next sample of a source, and where it goes.
class Feed {
 public:
  virtual ~Feed() = default;
  virtual bool empty() const = 0;
  virtual Time available() const = 0;
  virtual void deliver() = 0;
};

template <class T>
class FeedOf final : public Feed {
 public:
  FeedOf(sensors::Source<T>& source, fusion::GuardedFilter& filter)
      : source_(source), filter_(filter), more_(source_.next(sample_)) {}
  bool empty() const override { return !more_; }
  Time available() const override { return sample_.available; }
  void deliver() override {
    filter_.add(sample_);
    more_ = source_.next(sample_);
  }

 private:
  sensors::Source<T>& source_;
  fusion::GuardedFilter& filter_;
  T sample_;
  bool more_;
};

// Everything that is available by then, in the order of its delivery.
void deliver_until(std::vector<std::unique_ptr<Feed>>& feeds, Time t) {
  for (;;) {
    Feed* first = nullptr;
    for (const auto& feed : feeds) {
      if (!feed->empty() && feed->available() <= t &&
          (first == nullptr || feed->available() < first->available()))
        first = feed.get();
    }
    if (first == nullptr) return;
    first->deliver();
  }
}

// How far into a sequence its recorded tracks are good, s; 0: there are none.
double tracks_end(const std::string& sequence) {
  if (sequence == "06") return 103.5;
  return sequence == "01" ? 20.4 : 0.0;  // frames beyond 199 contradict the motion
}

using Labels = std::map<std::size_t, match::Label>;

std::int64_t way_driven_longest(const Labels& labels) {
  std::map<std::int64_t, std::size_t> rows;
  for (const auto& [row, label] : labels) ++rows[label.way_id];
  return std::max_element(rows.begin(), rows.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

mapmatch::NetworkData with_fault(const MapSetting& setting, const std::string& fault,
                                 const Labels& labels) {
  const mapmatch::NetworkData& network = setting.network->data();
  if (fault == "missing") return match::without_way(*setting.map, way_driven_longest(labels));
  if (fault == "shifted 5 m") return match::shifted(network, {5.0, 0.0});
  if (fault == "shifted 10 m") return match::shifted(network, {10.0, 0.0});
  if (fault == "reversed") return match::one_way_reversed(network);
  if (fault != "parallel 12 m")
    throw std::invalid_argument("no map fault is called '" + fault + "'");
  std::set<std::int64_t> driven;
  for (const auto& [row, label] : labels) driven.insert(label.way_id);
  return mapmatch::build_network(match::with_parallels(*setting.map, driven, 12.0));
}

// The row of the reference that is nearest to a moment.
std::size_t row_at(const std::vector<ReferencePose>& rows, Time t) {
  const auto after = std::lower_bound(rows.begin(), rows.end(), t,
                                      [](const ReferencePose& r, Time x) { return r.stamp < x; });
  if (after == rows.begin()) return rows.front().sequence;
  if (after == rows.end()) return rows.back().sequence;
  const auto before = std::prev(after);
  return (t - before->stamp < after->stamp - t ? before : after)->sequence;
}

vehicle::VehicleConfig config_of(const vehicle::VehicleConfig& given, const MapCase& setup) {
  vehicle::VehicleConfig config = given;
  set_configuration(config, setup.configuration);
  if (setup.mems) {
    set_imu_grade(config, "mems");
    config.imu_noise = "mems";
  }
  config.wheel.scale_error = setup.speed_scale;
  config.gnss.seed = config.wheel.seed = config.imu_seed = setup.seed;
  config.gnss_outage = setup.outages;
  return config;
}

}  // namespace

const std::vector<std::string>& map_faults() {
  static const std::vector<std::string> names{"missing", "shifted 5 m", "shifted 10 m", "reversed",
                                              "parallel 12 m"};
  return names;
}

void set_parameter(MapSetting& setting, const std::string& text) {
  const auto [wanted, number] = match::parse_setting(text);
  bool found = false;
  const auto set = [&, w = wanted, n = number](auto&... parameters) {
    found = (set_number(parameters, w, n) | ...);  // in each that has such a parameter
  };
  try {
    set(setting.match, setting.feedback, setting.guard, setting.config.fusion);
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error("--set " + text + ": " + e.what());
  }
  if (!found) throw std::runtime_error("--set " + text + ": there is no such parameter");
}

std::vector<MapCase> map_cases(const MapCases& wanted) {
  std::vector<MapCase> cases;
  std::vector<std::string> faults{""};
  faults.insert(faults.end(), wanted.faults.begin(), wanted.faults.end());
  MapCase c;
  c.speed_scale = wanted.speed_scale - 1.0;
  for (const std::string& configuration : wanted.configurations) {
    c.configuration = configuration;
    const bool with_tracks = configuration.find("VO") != std::string::npos && !wanted.poses;
    for (const std::string& unit : wanted.units) {
      c.mems = unit == "mems";
      for (const std::string& outage : wanted.outages) {
        c.outages = outage;
        for (const std::string& sequence : wanted.sequences) {
          c.sequence = sequence;
          c.end = with_tracks ? tracks_end(sequence) : 0.0;
          if (with_tracks && c.end == 0.0) continue;
          for (const std::string& fault : faults) {
            c.fault = fault;
            for (const MapMode mode : wanted.modes) {
              c.mode = mode;
              if (c.mode == MapMode::none && !fault.empty()) continue;
              for (c.seed = 1; c.seed <= wanted.seeds; ++c.seed) cases.push_back(c);
            }
          }
        }
      }
    }
  }
  return cases;
}

const fusion_score::Errors& without_gnss(const MapResult& result) {
  return result.score.outages.empty() ? result.score.whole : result.score.outages.front().errors;
}

MapResult run(const MapSetting& setting, const MapCase& setup) {
  vehicle::VehicleConfig config = config_of(setting.config, setup);
  const vehicle::Recording recording =
      vehicle::open_recording(setting.folder / setup.sequence, config);
  describe_car(config, recording.calibration);
  vehicle::Sensors sensors = recording.sensors(Time::min());
  if (setup.end > 0.0) limit(sensors, recording.first_stamp + from_seconds(setup.end));
  std::vector<ReferencePose> rows;
  const auto reference = recording.sensors(Time::max()).reference;
  for (ReferencePose row; reference->next(row);) rows.push_back(row);
  if (rows.size() < 2) throw std::runtime_error("sequence " + setup.sequence + " has no reference");
  const Labels labels =
      match::read_labels(setting.folder / "labels" / (setup.sequence + ".csv.gz"));
  std::optional<mapmatch::RoadNetwork> wrong;
  if (!setup.fault.empty()) wrong.emplace(with_fault(setting, setup.fault, labels));
  const mapmatch::RoadNetwork& network = wrong ? *wrong : *setting.network;

  fusion::GuardParameters guard = setting.guard;
  // The thesis's has no guard.
  if (setup.mode == MapMode::hard_reset)
    guard.difference_gate = std::numeric_limits<double>::infinity();
  fusion::GuardedFilter filter(fusion::ReducedImuFilter(config.fusion), guard);
  std::vector<std::unique_ptr<Feed>> feeds;
  const auto feed = [&]<class T>(const std::unique_ptr<sensors::Source<T>>& source) {
    if (source != nullptr) feeds.push_back(std::make_unique<FeedOf<T>>(*source, filter));
  };
  feed(sensors.imu);
  feed(sensors.gnss);
  feed(sensors.wheel);
  feed(sensors.odometry);

  mapmatch::Matcher matcher(network, *setting.rules, setting.match);
  mapmatch::FeedbackParameters feedback_parameters = setting.feedback;
  feedback_parameters.hard_reset = setup.mode == MapMode::hard_reset;
  mapmatch::Feedback feedback(network, feedback_parameters);
  const bool closed = setup.mode == MapMode::tight || setup.mode == MapMode::hard_reset;

  MapResult result;
  result.setup = setup;
  if (setup.fault == "missing") result.missing = way_driven_longest(labels);
  fusion_score::NavTrack track;
  std::vector<std::pair<NavState, MapSample>> sent;
  std::vector<match::MatchedFix> matched;
  std::vector<std::size_t> matched_rows;
  Time first = recording.first_stamp;
  if (!recording.outages.empty()) first = recording.outages.front().begin;
  const Time last =
      setup.end > 0.0 ? recording.first_stamp + from_seconds(setup.end) : recording.last_stamp;
  std::uint64_t tick = 0;
  for (Time k = recording.first_stamp; k <= last; k += tick_period) {
    deliver_until(feeds, k);
    auto state = filter.aided().state_at(k);
    if (!state) continue;
    state->sequence = 10 * tick++;
    track.add(*state);
    MapSample sample;
    const std::size_t row = row_at(rows, k);
    const auto label = labels.find(row);
    sample.on_missing =
        result.missing != 0 && label != labels.end() && label->second.way_id == result.missing;
    if (setup.mode != MapMode::none) {
      const mapmatch::VehicleFix fix = mapmatch::fix_of(*state);
      const mapmatch::MatchResult& match = matcher.add(fix);
      sample.probability = match.on_road ? match.probability : 0.0;
      if (k >= first) {
        matched.push_back(match::matched_fix(match, network));
        matched_rows.push_back(row);
      }
      if (closed) {
        const MapFeedback back = feedback.decide(match, fix);
        sample.reason = back.reason;
        ++result.reasons[static_cast<std::size_t>(back.reason)];
        filter.add(back);
      }
    }
    sent.emplace_back(*state, sample);
  }
  result.status = filter.aided().status();
  result.restorations = filter.status().restorations;
  result.match.add(matched, matched_rows, labels);

  const auto again = recording.sensors(Time::max()).reference;
  const auto score = fusion_score::score(track, *again, recording.outages, recording.first_stamp);
  if (!score) throw std::runtime_error("sequence " + setup.sequence + " gave nothing to score");
  result.score = *score;
  result.origin = filter.aided().frame().origin();
  const sensors::ReferenceTrajectory truth(rows, filter.aided().frame());
  for (auto& [state, sample] : sent) {
    const auto pose = truth.pose(state.stamp);
    if (!pose || truth.accuracy(state.stamp) > fusion_score::worst_reference) continue;
    sample.time = to_seconds(state.stamp - recording.first_stamp);
    sample.truth = pose->translation().head<2>();
    sample.error = state.position_enu.head<2>() - sample.truth;
    sample.azimuth = attitude_from_rotation(pose->rotation()).azimuth;
    sample.azimuth_error = wrap_angle(state.attitude.azimuth - sample.azimuth);
    const Eigen::Matrix2d P = state.covariance.topLeftCorner<2, 2>();
    sample.sigma = std::sqrt(P.trace());
    sample.nees = sample.error.dot(P.inverse() * sample.error);
    result.samples.push_back(sample);
  }
  return result;
}

}  // namespace maploop::experiments
