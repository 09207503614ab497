#include "estimators/fusion/reduced_imu_filter.h"

#include <algorithm>
#include <utility>

#include "estimators/fusion/event_update.h"
#include "estimators/fusion/initial_state.h"
#include "estimators/fusion/map_update.h"
#include "estimators/fusion/measurement_check.h"
#include "estimators/fusion/nav_state_output.h"
#include "estimators/fusion/parameter_table.h"
#include "msgs/archive.h"
#include "msgs/parameter_archive.h"

namespace maploop::fusion {
namespace {

const FusionParameters& checked(const FusionParameters& parameters) {
  validate_parameters(parameters);
  return parameters;
}

}  // namespace

ReducedImuFilter::ReducedImuFilter(const FusionParameters& parameters,
                                   std::optional<Geodetic> origin)
    : parameters_(checked(parameters)),
      sigmas_at_start_(
          initial_state(KnownStart{}, LocalFrame{}, parameters_).P.diagonal().cwiseSqrt()),
      has_origin_(origin.has_value()),
      frame_(origin.value_or(Geodetic{})),
      earth_(frame_.origin()),
      guard_(parameters_),
      history_(static_cast<std::size_t>(parameters.history_capacity)) {}

Outcome ReducedImuFilter::add(const ImuSample& sample) {
  if (const Reason reason = check_sample(sample, parameters_); reason != Reason::none) {
    return count(refused(reason));
  }
  start_where_left(sample.stamp);
  const EventKey key{sample.stamp, EventKind::imu, sample.sequence};
  if (const Reason reason = check_stamp(key); reason != Reason::none) return refuse_stamp(reason);
  if (const Reason reason = imu_clock_.check(sample); reason != Reason::none) {
    return count(refused(reason));
  }
  if (before_start(key)) return add_before_start(sample);
  make_room(1);
  if (key <= history_.past.key) return refuse_stamp(Reason::too_old);

  // The stretch since the previous sample was predicted by holding that sample; recompute it.
  const std::size_t redo = history_.after_last_sample(history_.position_after(key));
  const EventHistory::Past& past = history_.past;
  const bool reaches_into_past =
      redo == 0 && past.sample && past.sample->stamp < past.key.stamp &&
      sample.stamp - past.sample->stamp <= from_seconds(parameters_.imu_bridge) &&
      past.key.kind != EventKind::start;
  if (reaches_into_past) return refuse_stamp(Reason::too_old);
  return insert_and_roll(key, sample, redo);
}

Outcome ReducedImuFilter::add(const RelativeMotion& motion) {
  const bool used = parameters_.use_odometry_speed || parameters_.use_odometry_azimuth;
  const EventKey key{motion.stamp, EventKind::odometry, motion.sequence};
  const Reason reason = used ? check_motion(motion, parameters_) : Reason::not_configured;
  if (const auto refusal = refuse(reason, {key}, 2)) return *refusal;

  std::size_t redo = history_.position_after(key);
  const EventKey clone{motion.from, EventKind::clone, motion.sequence};
  if (motion.status == OdometryStatus::ok && clone > history_.past.key &&
      history_.past.state.clone_stamp != motion.from) {
    // A request is not needed if an odometry event, or another request, takes a clone at that time.
    const std::size_t place = history_.position_after(motion.from);
    const bool taken = place > 0 && history_[place - 1].key.stamp == motion.from &&
                       history_[place - 1].key.kind >= EventKind::odometry;
    if (!taken) redo = history_.insert(clone, CloneRequest{});
  }
  return moved_by(insert_and_roll(key, motion, redo));
}

Outcome ReducedImuFilter::add(const WheelSpeed& sample) {
  const EventKey key{sample.stamp, EventKind::wheel, sample.sequence};
  const Reason reason =
      parameters_.use_wheel_speed ? check_wheel(sample, parameters_) : Reason::not_configured;
  if (const auto refusal = refuse(reason, {key}, 1)) return *refusal;
  return moved_by(insert_and_roll(key, sample, history_.position_after(key)));
}

Outcome ReducedImuFilter::add(const MapFeedback& feedback) {
  const EventKey key{feedback.stamp, EventKind::map, feedback.sequence};
  if (const auto refusal = refuse(check_feedback(feedback, parameters_), {key}, 1)) return *refusal;
  return insert_and_roll(key, feedback, history_.position_after(key));
}

Outcome ReducedImuFilter::add(const GnssFix& fix) {
  start_where_left(start_stamp(fix));
  if (moved_by(fix)) forget_place(start_stamp(fix));
  if (!initialized_) return start(fix);
  Reason reason = parameters_.use_gnss ? check_fix(fix, parameters_) : Reason::already_started;
  if (reason == Reason::no_course) reason = Reason::none;  // only a start needs a course
  const EventKey velocity{fix.velocity_stamp, EventKind::gnss_velocity, fix.sequence};
  const EventKey position{fix.stamp, EventKind::gnss_position, fix.sequence};
  if (const auto refusal = refuse(reason, {velocity, position}, 2)) return *refusal;
  const std::size_t first = history_.insert(velocity, fix);
  return insert_and_roll(position, fix, first);
}

std::optional<Outcome> ReducedImuFilter::refuse(Reason reason, std::initializer_list<EventKey> keys,
                                                std::size_t events) {
  if (reason != Reason::none) return count(refused(reason));
  start_where_left(std::min(keys).stamp);
  for (const EventKey& key : keys) {
    if (const Reason stamp = check_stamp(key); stamp != Reason::none) return refuse_stamp(stamp);
    if (before_start(key)) return count(refused(Reason::before_start));
  }
  make_room(events);
  if (std::min(keys) <= history_.past.key) return refuse_stamp(Reason::too_old);
  return std::nullopt;
}

template <class Measurement>
Outcome ReducedImuFilter::insert_and_roll(const EventKey& key, const Measurement& measurement,
                                          std::size_t redo) {
  const std::size_t position = history_.insert(key, measurement);
  Outcome outcome{Disposition::held, Reason::none};
  if (initialized_) {
    roll_forward(std::min(redo, position));
    outcome = history_[position].outcome;
  }
  accept_stamp(key.stamp);
  return count(outcome);
}

Outcome ReducedImuFilter::count(Outcome outcome) {
  const bool held = outcome.disposition == Disposition::held;
  ++(outcome.refused() ? status_.refused[static_cast<std::size_t>(outcome.reason)]
                       : (held ? status_.held : status_.applied));
  return outcome;
}

Reason ReducedImuFilter::check_stamp(const EventKey& key) {
  const Reason reason = guard_.check(key.stamp);
  return reason == Reason::none && history_.contains(key) ? Reason::duplicate : reason;
}

Outcome ReducedImuFilter::refuse_stamp(Reason reason) {
  if (guard_.refuse(reason)) restart();
  return count(refused(reason));
}

void ReducedImuFilter::accept_stamp(Time stamp) {
  guard_.accept(stamp);
  while (history_.size() > 0 && history_[0].key.stamp < guard_.oldest()) drop_oldest();
}

void ReducedImuFilter::make_room(std::size_t events) {
  while (history_.size() + events > static_cast<std::size_t>(parameters_.history_capacity)) {
    drop_oldest();
    ++status_.shortened;
  }
}

void ReducedImuFilter::drop_oldest() {
  const Event& event = history_[0];
  if (initialized_) {
    history_.past.state = event.after;
  } else if (!std::holds_alternative<CloneRequest>(event.measurement)) {
    ++status_.unused;
  }
  history_.pop_front();
}

FilterStatus ReducedImuFilter::status() const {
  FilterStatus status = status_;
  const FilterState& newest = newest_state();
  status.recoveries = newest.recoveries;
  status.reinitializations = newest.reinitializations;
  return status;
}

SelfCalibrations ReducedImuFilter::calibration() const {
  return self_calibrations(newest_state(), sigmas_at_start_);
}

std::optional<FusedState> ReducedImuFilter::state_at(Time t) const {
  const std::optional<FilterState> state = predicted(t);
  if (!state) return std::nullopt;
  return fused_state(*state, frame_.origin(), parameters_);
}

std::optional<FilterState> ReducedImuFilter::predicted(Time t) const {
  if (!initialized_ || t < history_.past.state.stamp ||
      t > guard_.newest() + from_seconds(parameters_.max_gap)) {
    return std::nullopt;
  }
  const std::size_t position = history_.position_after(t);
  FilterState state = history_.state_before(position);
  advance(state, history_.samples_around(position), t, earth_, parameters_);
  return state;
}

void ReducedImuFilter::take_over(const ReducedImuFilter& other) {
  const FilterStatus counted = status_;
  *this = other;
  status_ = counted;
  ++status_.restorations;
}

template <class Archive, class Filter>
void ReducedImuFilter::describe(Archive& ar, Filter& f) {
  ar.section("reduced-IMU filter", 13);
  archive_same_parameters(ar, f.parameters_);
  Geodetic origin = f.frame_.origin();
  ar(f.remembered_, f.last_place_, f.has_origin_, origin, f.guard_, f.imu_clock_, f.history_,
     f.started_from_, f.slow_fix_, f.uncertain_since_, f.initialized_, f.status_);
  if constexpr (Archive::loading) {
    f.frame_ = LocalFrame(origin);
    f.earth_ = LocalEarth(origin);
  }
}

void ReducedImuFilter::archive(ArchiveWriter& ar) const {
  describe(ar, *this);
}

void ReducedImuFilter::archive(ArchiveReader& ar) {
  ReducedImuFilter loaded(parameters_);
  describe(ar, loaded);
  *this = std::move(loaded);
}

void ReducedImuFilter::roll_forward(std::size_t position) {
  FilterState state = history_.state_before(position);
  InertialSamples samples = history_.samples_around(position);
  for (std::size_t i = position; i < history_.size(); ++i) {
    Event& event = history_[i];
    advance(state, samples, event.key.stamp, earth_, parameters_);
    event.outcome = apply_event(state, event, samples, frame_, earth_, parameters_);
    event.after = state;
    if (const auto* sample = std::get_if<ImuSample>(&event.measurement)) {
      samples = {sample, history_.sample_from(i + 1), state.imu_repeated};
    }
  }
}

}  // namespace maploop::fusion
