#include "estimators/fusion/protection_monitor.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "estimators/fusion/parameter_table.h"
#include "msgs/archive.h"
#include "msgs/median.h"
#include "msgs/parameter_archive.h"
#include "msgs/protection_levels.h"

namespace maploop::fusion {
namespace {

constexpr Duration longest_gap = std::chrono::seconds(1);  // of the states, and of odometry

// One hypothesis on one axis: with this probability the error has this mean and deviation (m).
struct Hypothesis {
  double probability, mean, sigma;
};

double beyond(double level, const Hypothesis& h) {
  const double scale = 1.0 / (h.sigma * std::numbers::sqrt2);
  return h.probability * 0.5 *
         (std::erfc((level - h.mean) * scale) + std::erfc((level + h.mean) * scale));
}

// (40) of METHOD.md
double level_of(std::span<const Hypothesis> hypotheses, double risk) {
  double low = 0.0, high = 0.0;
  for (const Hypothesis& h : hypotheses) high = std::max(high, h.mean + 10.0 * h.sigma);
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    double sum = 0.0;
    for (const Hypothesis& h : hypotheses) sum += beyond(middle, h);
    (sum > risk ? low : high) = middle;
  }
  return high;
}

// Returns the derivative of a vector (east, north) by the azimuth that turns it clockwise.
Eigen::Vector2d turned(const Eigen::Vector2d& v) {
  return {v.y(), -v.x()};
}

Eigen::Vector2d turn(const Eigen::Vector2d& v, double azimuth) {
  return std::cos(azimuth) * v + std::sin(azimuth) * turned(v);
}

// Appends an element; an array that is full loses its first.
template <class T, std::size_t n>
T& append(std::array<T, n>& all, std::size_t& count) {
  if (count == n) {
    std::move(all.begin() + 1, all.end(), all.begin());
    --count;
  }
  return all[count++];
}

}  // namespace

ProtectionMonitor::ProtectionMonitor(const ProtectionParameters& parameters)
    : parameters_(parameters) {
  validate_parameters(parameters_);
}

void ProtectionMonitor::note(const GnssFix& fix, const ReducedImuFilter& filter) {
  const FusionParameters& p = filter.parameters();
  const auto state = filter.state_at(fix.stamp);
  if (!p.use_gnss || !state || state->status == NavStatus::without_course) return;
  const Eigen::Vector3d lever(p.gnss_lever_forward, p.gnss_lever_left, p.gnss_lever_up);
  const Eigen::Vector3d body =
      filter.frame().to_enu(fix.position) - rotation_enu_body(state->attitude) * lever;
  append(fixes_, fix_count_) = {fix.stamp, (body - state->position_enu).head<2>(),
                                fix.position_covariance.topLeftCorner<2, 2>()};
}

NavProtection ProtectionMonitor::levels(const FusedState& state, const GuardedFilter& filter) {
  follow(state);
  NavProtection result;
  static_cast<Sample&>(result) = state;
  result.sequence = state.sequence / NavProtection::every;
  result.risk = parameters_.integrity_risk;
  const TravelAxes axes = travel_axes(state.velocity_enu);
  const auto separation = [&](const std::optional<Alternative>& a) -> Separation {
    if (!a) return {};
    const auto sigma = [&](const Eigen::Vector2d& axis) {
      return std::sqrt(axis.dot(a->covariance * axis));
    };
    return {true, std::abs(axes.along.dot(a->apart)), std::abs(axes.across.dot(a->apart)),
            sigma(axes.along), sigma(axes.across)};
  };
  const Separation fused = separation(
      Alternative{Eigen::Vector2d::Zero(),
                  with_model(state.covariance.topLeftCorner<2, 2>(), way_ - way_at_fix_)});
  result.without_map = separation(without_map(state, filter));
  result.without_gnss = separation(without_gnss(state));
  result.without_odometry = separation(without_odometry(state));

  const auto level = [&](double Separation::*apart, double Separation::*sigma, double risk) {
    std::array<Hypothesis, 4> hypotheses{};
    std::size_t count = 0;
    const auto add = [&](const Separation& s, double fault) {
      if (s.known) hypotheses[count++] = {fault, s.*apart, s.*sigma};
    };
    add(fused, 1.0);
    add(result.without_map, parameters_.map_fault);
    add(result.without_gnss, parameters_.gnss_fault);
    add(result.without_odometry, parameters_.odometry_fault);
    return level_of(std::span(hypotheses).first(count), risk);
  };
  const auto along = [&](double risk) {
    return level(&Separation::along, &Separation::along_sigma, risk);
  };
  const auto across = [&](double risk) {
    return level(&Separation::across, &Separation::across_sigma, risk);
  };
  result.along = along(result.risk);
  result.across = across(result.risk);
  if (!axes.known) result.along = result.across = std::max(result.along, result.across);
  result.horizontal = std::hypot(along(0.5 * result.risk), across(0.5 * result.risk));
  return result;
}

// After a restart, or without odometry, the way until now says nothing.
void ProtectionMonitor::follow(const FusedState& state) {
  const Duration since = state.stamp - last_;
  if (since > Duration::zero() && since <= longest_gap)
    way_ += std::abs(state.forward_speed) * to_seconds(since);
  last_ = state.stamp;
  if (state.gnss_stamp != gnss_stamp_) {
    gnss_stamp_ = state.gnss_stamp;
    way_at_fix_ = way_;
  }
  const bool continuous =
      since > Duration::zero() && since <= longest_gap &&
      state.reinitializations == reinitializations_ &&
      state.odom.status != NavStatus::uninitialized &&
      state.stamp - std::max(state.odometry_stamp, state.wheel_stamp) <= longest_gap;
  reinitializations_ = state.reinitializations;
  if (!continuous) past_count_ = 0;
  if (state.odom.status == NavStatus::uninitialized) return;
  const Duration interval = from_seconds(parameters_.window / (most_pasts - 1));
  if (past_count_ > 0 && state.stamp - pasts_[past_count_ - 1].stamp < interval) return;
  Past& past = append(pasts_, past_count_);
  past = {state.stamp,
          state.position_enu.head<2>(),
          state.odom.position.head<2>(),
          state.attitude.azimuth,
          state.odom.attitude.azimuth,
          {},
          way_};
  constexpr int of[] = {0, 1, 6};  // east, north, azimuth
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) past.covariance(i, j) = state.covariance(of[i], of[j]);
  }
}

// (41) of METHOD.md
Eigen::Matrix2d ProtectionMonitor::with_model(const Eigen::Matrix2d& covariance, double way) const {
  const double share = parameters_.model_share * way;
  const double model = parameters_.model_sigma * parameters_.model_sigma + share * share;
  return parameters_.overconfidence * covariance + model * Eigen::Matrix2d::Identity();
}

std::optional<ProtectionMonitor::Alternative> ProtectionMonitor::without_map(
    const FusedState& state, const GuardedFilter& filter) const {
  const auto free = filter.without_map_at(state.stamp);
  if (!free) return std::nullopt;
  return Alternative{(free->position_enu - state.position_enu).head<2>(),
                     with_model(free->covariance.topLeftCorner<2, 2>(), way_ - way_at_fix_)};
}

// (42) of METHOD.md
std::optional<ProtectionMonitor::Alternative> ProtectionMonitor::without_gnss(
    const FusedState& state) const {
  if (past_count_ < 2 || state.gnss_stamp <= pasts_[0].stamp) return std::nullopt;
  const Past& past = pasts_[0];
  const Eigen::Vector2d moved =
      turn(state.odom.position.head<2>() - past.odom, past.azimuth - past.odom_azimuth);
  Eigen::Matrix<double, 2, 3> J;
  J << Eigen::Matrix2d::Identity(), turned(moved);
  return Alternative{past.position + moved - state.position_enu.head<2>(),
                     with_model(J * past.covariance * J.transpose(), way_ - past.way)};
}

std::optional<ProtectionMonitor::Alternative> ProtectionMonitor::without_odometry(
    const FusedState& state) const {
  std::array<double, most_fixes> east{}, north{};
  std::size_t count = 0;
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (const Fix& fix : std::span(fixes_).first(fix_count_)) {
    if (fix.stamp > state.stamp || to_seconds(state.stamp - fix.stamp) > parameters_.fix_memory)
      continue;
    east[count] = fix.apart.x();
    north[count++] = fix.apart.y();
    sum += fix.covariance;
  }
  if (count == 0) return std::nullopt;
  return Alternative{{median(std::span(east).first(count)), median(std::span(north).first(count))},
                     with_model(sum / static_cast<double>(count), 0.0)};
}

template <class Archive, class Monitor>
void ProtectionMonitor::describe(Archive& ar, Monitor& m) {
  ar.section("protection", 1);
  archive_same_parameters(ar, m.parameters_);
  ar(m.pasts_, m.past_count_, m.fixes_, m.fix_count_, m.last_, m.reinitializations_, m.gnss_stamp_,
     m.way_, m.way_at_fix_);
}

void ProtectionMonitor::archive(ArchiveWriter& ar) const {
  describe(ar, *this);
}

void ProtectionMonitor::archive(ArchiveReader& ar) {
  ProtectionMonitor loaded(parameters_);
  describe(ar, loaded);
  if (loaded.past_count_ > most_pasts || loaded.fix_count_ > most_fixes)
    throw ArchiveError("the protection levels have more of the past than they keep");
  *this = loaded;
}

}  // namespace maploop::fusion
