#include "tools/experiments/map_experiment.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>

#include "estimators/fusion/reduced_imu_filter.h"
#include "mapmatch/matcher.h"
#include "runtime/vehicle/limited_source.h"
#include "runtime/vehicle/recording.h"
#include "sensors/replay/reference_trajectory.h"
#include "tools/match/labels.h"

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
  FeedOf(sensors::Source<T>& source, fusion::ReducedImuFilter& filter)
      : source_(source), filter_(filter), more_(source_.next(sample_)) {}
  bool empty() const override { return !more_; }
  Time available() const override { return sample_.available; }
  void deliver() override {
    filter_.add(sample_);
    more_ = source_.next(sample_);
  }

 private:
  sensors::Source<T>& source_;
  fusion::ReducedImuFilter& filter_;
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

mapmatch::VehicleFix fix_of(const NavState& state) {
  mapmatch::VehicleFix fix;
  fix.stamp = state.stamp;
  fix.position = LocalFrame(state.origin).to_geodetic(state.position_enu);
  fix.covariance = state.covariance.topLeftCorner<2, 2>();
  const double s = std::sin(state.attitude.azimuth), c = std::cos(state.attitude.azimuth);
  const Eigen::Vector2d forward(s, c);
  fix.speed = state.forward_speed;
  fix.speed_sigma = std::sqrt(forward.dot(state.covariance.block<2, 2>(3, 3) * forward));
  fix.azimuth = state.attitude.azimuth;
  fix.azimuth_sigma = std::sqrt(state.covariance(6, 6));
  return fix;
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

MapMode map_mode(const std::string& name) {
  for (const MapMode mode : {MapMode::none, MapMode::loose, MapMode::tight, MapMode::hard_reset})
    if (to_string(mode) == name) return mode;
  throw std::invalid_argument("no map mode is called '" + name +
                              "'; there are none, loose, tight, hard-reset");
}

std::string to_string(MapMode mode) {
  switch (mode) {
    case MapMode::none:
      return "none";
    case MapMode::loose:
      return "loose";
    case MapMode::tight:
      return "tight";
    case MapMode::hard_reset:
      return "hard-reset";
  }
  return "unknown";
}

const fusion_score::Errors& without_gnss(const MapResult& result) {
  return result.score.outages.empty() ? result.score.whole : result.score.outages.front().errors;
}

MapResult run(const MapSetting& setting, const MapCase& setup) {
  const vehicle::VehicleConfig config = config_of(setting.config, setup);
  const vehicle::Recording recording =
      vehicle::open_recording(setting.folder / setup.sequence, config);
  vehicle::Sensors sensors = recording.sensors(Time::min());
  if (setup.end > 0.0) limit(sensors, recording.first_stamp + from_seconds(setup.end));
  std::vector<ReferencePose> rows;
  const auto reference = recording.sensors(Time::max()).reference;
  for (ReferencePose row; reference->next(row);) rows.push_back(row);
  if (rows.size() < 2) throw std::runtime_error("sequence " + setup.sequence + " has no reference");
  const auto labels = match::read_labels(setting.folder / "labels" / (setup.sequence + ".csv.gz"));

  fusion::ReducedImuFilter filter(config.fusion);
  std::vector<std::unique_ptr<Feed>> feeds;
  const auto feed = [&]<class T>(const std::unique_ptr<sensors::Source<T>>& source) {
    if (source != nullptr) feeds.push_back(std::make_unique<FeedOf<T>>(*source, filter));
  };
  feed(sensors.imu);
  feed(sensors.gnss);
  feed(sensors.wheel);
  feed(sensors.odometry);

  mapmatch::Matcher matcher(*setting.network, *setting.rules, setting.match);
  mapmatch::FeedbackParameters feedback_parameters = setting.feedback;
  feedback_parameters.hard_reset = setup.mode == MapMode::hard_reset;
  mapmatch::Feedback feedback(*setting.network, feedback_parameters);
  const bool closed = setup.mode == MapMode::tight || setup.mode == MapMode::hard_reset;

  MapResult result;
  result.setup = setup;
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
    auto state = filter.state_at(k);
    if (!state) continue;
    state->sequence = 10 * tick++;
    track.add(*state);
    MapSample sample;
    if (setup.mode != MapMode::none) {
      const mapmatch::VehicleFix fix = fix_of(*state);
      const mapmatch::MatchResult& match = matcher.add(fix);
      sample.probability = match.on_road ? match.probability : 0.0;
      if (k >= first) {
        matched.push_back(match::matched_fix(match, *setting.network));
        matched_rows.push_back(row_at(rows, k));
      }
      if (closed) {
        const MapFeedback back = feedback.decide(match, fix);
        sample.reason = back.reason;
        ++result.reasons[static_cast<std::size_t>(back.reason)];
        if (back.position || back.azimuth) filter.add(back);
      }
    }
    sent.emplace_back(*state, sample);
  }
  result.status = filter.status();
  result.match.add(matched, matched_rows, labels);

  const auto again = recording.sensors(Time::max()).reference;
  const auto score = fusion_score::score(track, *again, recording.outages, recording.first_stamp);
  if (!score) throw std::runtime_error("sequence " + setup.sequence + " gave nothing to score");
  result.score = *score;
  result.origin = filter.frame().origin();
  const sensors::ReferenceTrajectory truth(rows, filter.frame());
  for (auto& [state, sample] : sent) {
    const auto pose = truth.pose(state.stamp);
    if (!pose) continue;
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
