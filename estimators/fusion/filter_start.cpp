// This file starts the filter, takes an inertial sample from before the start, restarts the filter
// when the clock of its data has jumped, and judges the place where the vehicle was left.
#include <cmath>
#include <utility>

#include "estimators/fusion/gnss_update.h"
#include "estimators/fusion/initial_state.h"
#include "estimators/fusion/nav_state_output.h"
#include "estimators/fusion/reduced_imu_filter.h"

namespace maploop::fusion {
namespace {

// Returns whether the filter is linear enough in the error of the azimuth, as after a gap of 1 s.
bool knows_course(const FilterState& state) {
  constexpr double linear = 0.35;  // rad
  return state.P(index::azimuth, index::azimuth) <= linear * linear;
}

}  // namespace

Outcome ReducedImuFilter::start(const GnssFix& fix) {
  Reason reason = check_fix(fix, parameters_);
  if (reason == Reason::no_course && waited_for_course(fix) && shows_late_course(fix, parameters_))
    reason = Reason::none;
  if (reason == Reason::no_course) {
    status_.phase = Phase::waiting_for_motion;
    if (!slow_fix_ || slow_fix_->stamp < fix.stamp) slow_fix_ = fix;
    if (!has_origin_) set_origin(fix.position);
  }
  const Outcome outcome =
      start_with(reason, start_stamp(fix), fix.position, [&] { return state_from(fix); });
  if (!outcome.refused()) started_from_ = fix;
  return outcome;
}

// The time counts from the first fix that moves, because a velocity becomes certain only then.
bool ReducedImuFilter::waited_for_course(const GnssFix& fix) {
  if (!moves(fix, parameters_)) return false;
  if (uncertain_since_ == Time{} || fix.stamp < uncertain_since_) uncertain_since_ = fix.stamp;
  return fix.stamp - uncertain_since_ >= from_seconds(parameters_.late_course_after);
}

void ReducedImuFilter::set_origin(const Geodetic& origin) {
  frame_ = LocalFrame(origin);
  earth_ = LocalEarth(origin);
  has_origin_ = true;
}

std::optional<FusedState> ReducedImuFilter::state_without_course_at(Time t) const {
  if (initialized_ || !slow_fix_ || t < slow_fix_->stamp ||
      t > slow_fix_->stamp + from_seconds(parameters_.max_gap)) {
    return std::nullopt;
  }
  return state_without_course(*slow_fix_, t, frame_, parameters_);
}

// The yaw rate is that of the last sample before the start, which may still be to come.
FilterState ReducedImuFilter::state_from(const GnssFix& fix) const {
  const double yaw_rate = history_.past.sample ? history_.past.sample->yaw_rate : 0.0;
  return initial_state(fix, frame_, parameters_, yaw_rate);
}

Outcome ReducedImuFilter::start(const KnownStart& known) {
  return start_with(initialized_ ? Reason::already_started : check_start(known), known.stamp,
                    known.position, [&] { return initial_state(known, frame_, parameters_); });
}

void ReducedImuFilter::recall(const LastPlace& place) {
  last_place_ = place;
  status_.place = PlaceUse::remembered;
}

std::optional<LastPlace> ReducedImuFilter::here() const {
  return initialized_ ? std::optional(fusion::last_place(newest_state(), frame_)) : std::nullopt;
}

void ReducedImuFilter::start_where_left(Time first) {
  if (initialized_ || status_.place != PlaceUse::remembered) return;
  const PlaceStart known = start_at(last_place_, first, parameters_);
  status_.place = known.use;
  if (known.use != PlaceUse::started) return;
  if (start(known.start).refused()) {
    status_.place = PlaceUse::too_uncertain;
  } else {
    accept_stamp(first);  // the gap before it is known
  }
}

bool ReducedImuFilter::moved_by(const GnssFix& whole) {
  if (!initialized_ || (status_.place != PlaceUse::started && status_.place != PlaceUse::seen))
    return false;
  const GnssFix fix = whole.alone();
  const Reason reason = check_fix(fix, parameters_);
  if (reason != Reason::none && reason != Reason::no_course) return false;
  const auto at_position = predicted(fix.stamp), at_velocity = predicted(fix.velocity_stamp);
  if (!at_position || !at_velocity) return false;
  if (status_.place == PlaceUse::started) {
    const double apart =
        position_innovation(*at_position, fix, frame_, parameters_).nis(at_position->P);
    if (!(apart <= parameters_.gnss_position_gate)) return true;
    status_.place = PlaceUse::seen;
  }
  if (reason == Reason::no_course) return false;
  const bool course = knows_course(*at_velocity);
  const auto apart = [&] {
    return velocity_innovation(*at_velocity, fix, at_velocity->yaw_rate, parameters_)
        .nis(at_velocity->P);
  };
  if (course && !(apart() <= parameters_.gnss_velocity_gate)) return true;
  status_.place = PlaceUse::confirmed;
  if (!course) take_course(fix);
  return false;
}

// A vehicle that was carried over a gap may have turned there by more than the filter is linear in.
// So it starts once more, where it is, with the course of the fix, which corrects it afterwards.
void ReducedImuFilter::take_course(const GnssFix& fix) {
  constexpr double unknown = 0.3;  // rad: more than the uncertainty of the fix, and still linear
  const Time now = start_stamp(fix);
  const auto state = predicted(now);
  if (!state) return;
  KnownStart known = known_start(fusion::last_place(*state, frame_));
  const Eigen::Vector2d travel = (known.speed < 0.0 ? -1.0 : 1.0) * fix.velocity_enu.head<2>();
  known.attitude.azimuth = std::atan2(travel.x(), travel.y());
  known.azimuth_sigma = unknown;
  while (history_.size() > 0 && history_[0].key.stamp < now) drop_oldest();
  initialized_ = false;
  if (start(known).refused()) return;
  history_.past.state.odom_at_clone = state->odom_of_described();
  roll_forward(0);
}

// The first speed that odometry or the wheels measure shows whether the vehicle still stands, or
// still drives, as it was left.
Outcome ReducedImuFilter::moved_by(Outcome of_speed) {
  const FilterState& state = newest_state();
  const bool contradicts =
      of_speed.reason == Reason::speed_gate || of_speed.reason == Reason::wheel_gate;
  if (initialized_ && status_.place == PlaceUse::started && contradicts &&
      state.odometry_applied == 0 && state.wheel_stamp == Time{}) {
    forget_place(state.stamp);
  }
  return of_speed;
}

// The measurements from `from` on stay, as for a filter that has not started.
void ReducedImuFilter::forget_place(Time from) {
  while (history_.size() > 0 && history_[0].key.stamp < from) drop_oldest();
  status_.place = PlaceUse::moved;
  status_.phase = Phase::waiting_for_fix;
  initialized_ = false;
  // The origin that came from the place may be too far from where the vehicle is.
  if (frame_.origin() == last_place_.position) has_origin_ = false;
}

template <class MakeState>
Outcome ReducedImuFilter::start_with(Reason reason, Time stamp, const Geodetic& position,
                                     MakeState make_state) {
  if (reason != Reason::none) return count(refused(reason));
  const EventKey key{stamp, EventKind::start, 0};
  if (reason = check_stamp(key); reason != Reason::none) return refuse_stamp(reason);
  if (key < history_.past.key) return refuse_stamp(Reason::too_old);
  if (has_origin_ && !(frame_.to_enu(position).norm() <= parameters_.max_origin_distance)) {
    return count(refused(Reason::too_far_from_origin));
  }

  if (!has_origin_) set_origin(position);
  while (history_.size() > 0 && history_[0].key < key) drop_oldest();
  EventHistory::Past& past = history_.past;
  past.state = make_state();
  started_from_.reset();
  fusion::recall(past.state, remembered_, sigmas_at_start_);
  past.key = key;
  if (past.sample) past.state.imu_stamp = past.sample->stamp;
  initialized_ = true;
  status_.phase = Phase::running;
  roll_forward(0);
  accept_stamp(key.stamp);
  return count({});
}

// Restarts in the same frame with an empty history, because the clock of the data has jumped.
void ReducedImuFilter::restart() {
  history_.clear();
  history_.past = {};
  initialized_ = false;
  slow_fix_.reset();
  uncertain_since_ = {};
  guard_.reset();
  imu_clock_ = {};
  if (!dropped(status_.place)) status_.place = PlaceUse::none;  // it was of the old clock
  status_.phase = Phase::waiting_for_fix;
  ++status_.restarts;
}

// The interpolation of the first stretch begins at the last sample before the start, and the start
// from a fix depends on its yaw rate.
Outcome ReducedImuFilter::add_before_start(const ImuSample& sample) {
  const auto order = [](const ImuSample& s) { return std::pair(s.stamp, s.sequence); };
  EventHistory::Past& past = history_.past;
  if (past.sample && order(sample) <= order(*past.sample)) {
    const bool known = order(sample) == order(*past.sample);
    return count(refused(known ? Reason::duplicate : Reason::before_start));
  }
  past.sample = sample;
  if (started_from_) {
    past.state = state_from(*started_from_);
    fusion::recall(past.state, remembered_, sigmas_at_start_);
  }
  past.state.imu_stamp = sample.stamp;
  roll_forward(0);
  accept_stamp(sample.stamp);
  return count({});
}

}  // namespace maploop::fusion
