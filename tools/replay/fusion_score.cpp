#include "tools/replay/fusion_score.h"

#include <fmt/format.h>
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>

#include "msgs/frames.h"
#include "sensors/replay/reference_trajectory.h"
#include "tools/command/median.h"
#include "tools/replay/figures.h"

namespace maploop::fusion_score {
namespace {

// Error of one state.
struct Sample {
  Time stamp;
  Eigen::Vector2d truth;     // m, enu
  Eigen::Vector2d position;  // m, error
  bool has_course;
  double azimuth;  // rad, error
  double nees;
  double azimuth_sigma;  // rad, of the state
  double accuracy;       // m, of the reference
};

double median_accuracy(const std::vector<Sample>& samples) {
  std::vector<double> values;
  values.reserve(samples.size());
  for (const Sample& s : samples) values.push_back(s.accuracy);
  return tools::median(values);
}

constexpr Duration neighbours = std::chrono::milliseconds(500);

// The longest time for which all successive samples are bad. Two samples further apart than
// `neighbours` are not successive.
template <class Iterator, class Bad>
double longest(Iterator first, Iterator last, Bad bad) {
  Duration most{};
  Time since{};
  for (auto s = first; s != last; ++s) {
    const bool goes_on =
        s != first && bad(*std::prev(s)) && s->stamp - std::prev(s)->stamp <= neighbours;
    if (!bad(*s)) continue;
    if (!goes_on) since = s->stamp;
    most = std::max(most, s->stamp - since);
  }
  return to_seconds(most);
}

Errors errors_between(const std::vector<Sample>& samples, Time begin, Time end, double states) {
  Errors e;
  const auto before = [](const Sample& s, Time t) { return s.stamp < t; };
  const auto first = std::lower_bound(samples.begin(), samples.end(), begin, before);
  const auto last = std::lower_bound(first, samples.end(), end, before);
  const auto n = static_cast<double>(last - first);
  if (last - first < 2) return e;
  const auto directed =
      static_cast<double>(std::count_if(first, last, [](const Sample& s) { return s.has_course; }));
  for (auto s = first; s != last; ++s) {
    const double error = s->position.norm();
    if (s != first) e.distance += (s->truth - std::prev(s)->truth).norm();
    e.rmse += error * error / n;
    if (s->has_course) e.azimuth_rms += s->azimuth * s->azimuth / directed;
    e.nees_mean += s->nees / n;
    e.max = std::max(e.max, error);
    e.nees_max = std::max(e.nees_max, s->nees);
  }
  constexpr double three_sigmas = 11.83;  // chi-square, two degrees of freedom
  e.beyond = longest(first, last, [](const Sample& s) { return s.nees > three_sigmas; });
  e.azimuth_beyond = longest(first, last, [](const Sample& s) {
    return s.has_course && std::abs(s.azimuth) > 3.0 * s.azimuth_sigma;
  });
  e.rmse = std::sqrt(e.rmse);
  e.azimuth_rms = degrees(std::sqrt(e.azimuth_rms));
  e.azimuth_end = degrees(std::prev(last)->azimuth);
  e.nees_end = std::prev(last)->nees;
  e.drift = (std::prev(last)->position - first->position).norm();
  e.covered = std::min(1.0, n / std::max(states, 1.0));
  return e;
}

}  // namespace

bool NavTrack::add(const NavState& state) {
  if (state.status == NavStatus::uninitialized || state.sequence % NavProtection::every != 0)
    return false;
  // A replay may go back.
  while (!states_.empty() && states_.back().stamp >= state.stamp) states_.pop_back();
  states_.push_back(state);
  return true;
}

double NavTrack::silent_until(Time end) const {
  Duration silent{};
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const Duration step = (i + 1 < states_.size() ? states_[i + 1].stamp : end) - states_[i].stamp;
    if (step > neighbours) silent += step;
  }
  return to_seconds(silent);
}

std::vector<ScoredState> scored_states(const NavTrack& track,
                                       const std::vector<ReferencePose>& reference) {
  std::vector<ScoredState> states;
  if (reference.size() < 2 || track.states().empty()) return states;
  const sensors::ReferenceTrajectory truth(reference, LocalFrame(track.states().front().origin));
  for (const NavState& state : track.states()) {
    if (const auto pose = truth.pose(state.stamp))
      states.push_back({&state, *pose, truth.accuracy(state.stamp)});
  }
  const auto bad = [](const ScoredState& s) { return s.accuracy > worst_reference; };
  if (std::count_if(states.begin(), states.end(), std::not_fn(bad)) > 1) {
    std::erase_if(states, bad);
  }
  return states;
}

std::optional<Score> score(const NavTrack& track, const std::vector<ReferencePose>& reference,
                           const std::vector<vehicle::GnssOutage>& outages, Time origin, Time named,
                           Time from) {
  std::vector<Sample> samples;
  for (const ScoredState& scored : scored_states(track, reference)) {
    const NavState& state = *scored.state;
    Sample s;
    s.stamp = state.stamp;
    s.truth = scored.truth.translation().head<2>();
    s.position = state.position_enu.head<2>() - s.truth;
    s.has_course = state.status != NavStatus::without_course;
    s.azimuth = wrap_angle(state.attitude.azimuth -
                           attitude_from_rotation(scored.truth.rotation()).azimuth);
    s.azimuth_sigma = std::sqrt(state.covariance(6, 6));
    s.accuracy = scored.accuracy;
    const Eigen::Matrix2d C = state.covariance.topLeftCorner<2, 2>() +
                              s.accuracy * s.accuracy * Eigen::Matrix2d::Identity();
    s.nees = s.position.dot(C.inverse() * s.position);
    samples.push_back(s);
  }
  if (samples.size() < 2) return std::nullopt;

  const auto states_in = [&](Time begin, Time end) {
    return static_cast<double>(
        std::count_if(track.states().begin(), track.states().end(),
                      [&](const NavState& s) { return s.stamp >= begin && s.stamp < end; }));
  };
  Score result;
  result.reference_accuracy = median_accuracy(samples);
  result.whole = errors_between(samples, from, Time::max(), states_in(from, Time::max()));
  const Errors before = errors_between(samples, from, named, 0.0);
  result.unsaid = std::max(before.beyond, before.azimuth_beyond);
  const Time last = samples.back().stamp;
  for (const vehicle::GnssOutage& o : outages) {
    const Time end = std::min(o.end, last);
    if (o.begin >= end) continue;
    result.outages.push_back({to_seconds(o.begin - origin), to_seconds(end - o.begin),
                              errors_between(samples, o.begin, end, states_in(o.begin, end))});
  }
  return result;
}

std::string to_text(const Score& score) {
  std::string text =
      "\nState as sent           distance    rmse     max   drift    drift  azimuth deg      NEES\n"
      "                               m       m       m       m        %     rms    end  mean   "
      " end\n";
  const auto line = [&](const std::string& name, const Errors& e) {
    text += fmt::format("  {:20}{}\n", name, web::to_text(tools::error_columns, e));
    if (e.covered >= 0.98) return;
    text += fmt::format(
        "  {:20} scored where there is a reference better than {:.1f} m: {:.0f} % of the time\n",
        "", worst_reference, 100.0 * e.covered);
  };
  line("whole drive", score.whole);
  for (const OutageErrors& o : score.outages)
    line(fmt::format("outage {:.1f}:{:.1f}", o.start, o.length), o.errors);
  return text + fmt::format("  The reference says of itself that it is right to {:.2f} m.\n",
                            score.reference_accuracy);
}

}  // namespace maploop::fusion_score
