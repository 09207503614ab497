#include "estimators/fusion/reduced_imu_filter.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "estimators/fusion/gnss_update.h"
#include "estimators/fusion/initial_state.h"
#include "estimators/fusion/map_update.h"
#include "estimators/fusion/measurement_check.h"
#include "estimators/fusion/mechanization.h"
#include "estimators/fusion/nav_state_output.h"
#include "estimators/fusion/odometry_update.h"
#include "estimators/fusion/parameter_table.h"
#include "estimators/fusion/roll_update.h"
#include "estimators/fusion/wheel_update.h"
#include "estimators/fusion/zero_velocity.h"
#include "msgs/archive.h"
#include "msgs/parameter_archive.h"

namespace maploop::fusion {
namespace {

const FusionParameters& checked(const FusionParameters& parameters) {
  validate_parameters(parameters);
  return parameters;
}

EventKey last_key_at(Time stamp) {
  return {stamp, EventKind::clone, std::numeric_limits<std::uint64_t>::max()};
}

// Interpolates linearly between samples; after the newest one, returns its own value.
double yaw_rate_at(const InertialSamples& samples, Time t) {
  if (samples.before == nullptr) return 0.0;
  const ImuSample& a = *samples.before;
  if (samples.after == nullptr) return a.yaw_rate;
  const double gap = to_seconds(samples.after->stamp - a.stamp);
  const double share = gap > 0.0 ? to_seconds(t - a.stamp) / gap : 0.0;
  return a.yaw_rate + share * (samples.after->yaw_rate - a.yaw_rate);
}

}  // namespace

ReducedImuFilter::ReducedImuFilter(const FusionParameters& parameters,
                                   std::optional<Geodetic> origin)
    : parameters_(checked(parameters)),
      has_origin_(origin.has_value()),
      frame_(origin.value_or(Geodetic{})),
      earth_(frame_.origin()),
      guard_(parameters_),
      history_(static_cast<std::size_t>(parameters.history_capacity)) {}

Outcome ReducedImuFilter::add(const ImuSample& sample) {
  if (const Reason reason = check_sample(sample, parameters_); reason != Reason::none) {
    return count(refused(reason));
  }
  const EventKey key{sample.stamp, EventKind::imu, sample.sequence};
  if (const Reason reason = check_stamp(key); reason != Reason::none) return refuse_stamp(reason);
  if (const Reason reason = imu_clock_.check(sample); reason != Reason::none) {
    return count(refused(reason));
  }
  if (key < base_key_ && started_here()) return add_before_start(sample);
  make_room(1);
  if (key <= base_key_) return refuse_stamp(Reason::too_old);

  // The stretch since the previous sample was predicted by holding that sample; recompute it.
  std::size_t redo = history_.position_after(key);
  while (redo > 0 && history_[redo - 1].key.kind != EventKind::imu) --redo;
  const bool reaches_into_base =
      redo == 0 && base_sample_ && base_sample_->stamp < base_key_.stamp &&
      sample.stamp - base_sample_->stamp <= from_seconds(parameters_.imu_bridge) &&
      base_key_.kind != EventKind::start;
  if (reaches_into_base) return refuse_stamp(Reason::too_old);
  return insert_and_roll(key, sample, redo);
}

// The interpolation of the first stretch begins at the last sample before the start.
Outcome ReducedImuFilter::add_before_start(const ImuSample& sample) {
  const auto order = [](const ImuSample& s) { return std::pair(s.stamp, s.sequence); };
  if (base_sample_ && order(sample) <= order(*base_sample_)) {
    return count(refused(Reason::before_start));
  }
  base_sample_ = sample;
  base_.imu_stamp = sample.stamp;
  roll_forward(0);
  accept_stamp(sample.stamp);
  return count({});
}

Outcome ReducedImuFilter::add(const RelativeMotion& motion) {
  if (!parameters_.use_odometry_speed && !parameters_.use_odometry_azimuth) {
    return count(refused(Reason::not_configured));
  }
  if (const Reason reason = check_motion(motion, parameters_); reason != Reason::none) {
    return count(refused(reason));
  }
  const EventKey key{motion.stamp, EventKind::odometry, motion.sequence};
  if (const Reason reason = check_stamp(key); reason != Reason::none) return refuse_stamp(reason);
  if (key < base_key_ && started_here()) return count(refused(Reason::before_start));
  make_room(2);
  if (key <= base_key_) return refuse_stamp(Reason::too_old);

  std::size_t redo = history_.position_after(key);
  const EventKey clone{motion.from, EventKind::clone, motion.sequence};
  if (motion.status == OdometryStatus::ok && clone > base_key_ &&
      base_.clone_stamp != motion.from) {
    // A request is not needed if an odometry event, or another request, takes a clone at that time.
    const std::size_t place = history_.position_after(last_key_at(motion.from));
    const bool taken = place > 0 && history_[place - 1].key.stamp == motion.from &&
                       history_[place - 1].key.kind >= EventKind::odometry;
    if (!taken) redo = history_.insert(clone, CloneRequest{});
  }
  return insert_and_roll(key, motion, redo);
}

Outcome ReducedImuFilter::add(const WheelSpeed& sample) {
  if (!parameters_.use_wheel_speed) return count(refused(Reason::not_configured));
  if (const Reason reason = check_wheel(sample, parameters_); reason != Reason::none) {
    return count(refused(reason));
  }
  const EventKey key{sample.stamp, EventKind::wheel, sample.sequence};
  if (const Reason reason = check_stamp(key); reason != Reason::none) return refuse_stamp(reason);
  if (key < base_key_ && started_here()) return count(refused(Reason::before_start));
  make_room(1);
  if (key <= base_key_) return refuse_stamp(Reason::too_old);
  return insert_and_roll(key, sample, history_.position_after(key));
}

Outcome ReducedImuFilter::add(const GnssFix& fix) {
  if (!initialized_) return start(fix);
  return parameters_.use_gnss ? correct(fix) : count(refused(Reason::already_started));
}

Outcome ReducedImuFilter::add(const MapFeedback& feedback) {
  if (const Reason reason = check_feedback(feedback, parameters_); reason != Reason::none) {
    return count(refused(reason));
  }
  const EventKey key{feedback.stamp, EventKind::map, feedback.sequence};
  if (const Reason reason = check_stamp(key); reason != Reason::none) return refuse_stamp(reason);
  if (key < base_key_ && started_here()) return count(refused(Reason::before_start));
  make_room(1);
  if (key <= base_key_) return refuse_stamp(Reason::too_old);
  return insert_and_roll(key, feedback, history_.position_after(key));
}

Outcome ReducedImuFilter::correct(const GnssFix& fix) {
  const Reason reason = check_fix(fix, parameters_);
  if (reason != Reason::none && reason != Reason::too_slow) return count(refused(reason));
  const EventKey velocity{fix.velocity_stamp, EventKind::gnss_velocity, fix.sequence};
  const EventKey position{fix.stamp, EventKind::gnss_position, fix.sequence};
  for (const EventKey& key : {velocity, position}) {
    if (const Reason stamp = check_stamp(key); stamp != Reason::none) return refuse_stamp(stamp);
    if (key < base_key_ && started_here()) return count(refused(Reason::before_start));
  }
  make_room(2);
  if (std::min(velocity, position) <= base_key_) return refuse_stamp(Reason::too_old);
  const std::size_t first = history_.insert(velocity, fix);
  return insert_and_roll(position, fix, first);
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

Outcome ReducedImuFilter::start(const GnssFix& fix) {
  const Reason reason = check_fix(fix, parameters_);
  if (reason == Reason::too_slow) status_.phase = Phase::waiting_for_motion;
  if (reason != Reason::none) return count(refused(reason));
  return start_with(start_stamp(fix), fix.position,
                    [&] { return initial_state(fix, frame_, parameters_); });
}

Outcome ReducedImuFilter::start(const KnownStart& known) {
  if (initialized_) return count(refused(Reason::already_started));
  if (const Reason reason = check_start(known); reason != Reason::none) {
    return count(refused(reason));
  }
  return start_with(known.stamp, known.position,
                    [&] { return initial_state(known, frame_, parameters_); });
}

template <class MakeState>
Outcome ReducedImuFilter::start_with(Time stamp, const Geodetic& position, MakeState make_state) {
  const EventKey key{stamp, EventKind::start, 0};
  if (const Reason reason = check_stamp(key); reason != Reason::none) return refuse_stamp(reason);
  if (key < base_key_) return refuse_stamp(Reason::too_old);
  if (has_origin_ && !(frame_.to_enu(position).norm() <= parameters_.max_origin_distance)) {
    return count(refused(Reason::too_far_from_origin));
  }

  if (!has_origin_) {
    frame_ = LocalFrame(position);
    earth_ = LocalEarth(position);
    has_origin_ = true;
  }
  while (history_.size() > 0 && history_[0].key < key) drop_oldest();
  base_ = make_state();
  base_key_ = key;
  if (base_sample_) base_.imu_stamp = base_sample_->stamp;
  initialized_ = true;
  status_.phase = Phase::running;
  roll_forward(0);
  accept_stamp(key.stamp);
  return count({});
}

// Restarts in the same frame with an empty history, because the clock of the data has jumped.
void ReducedImuFilter::restart() {
  history_.clear();
  base_ = {};
  base_key_ = {};
  base_sample_.reset();
  initialized_ = false;
  guard_.reset();
  imu_clock_ = {};
  status_.phase = Phase::waiting_for_fix;
  ++status_.restarts;
}

Outcome ReducedImuFilter::count(Outcome outcome) {
  switch (outcome.disposition) {
    case Disposition::applied:
      ++status_.applied;
      break;
    case Disposition::held:
      ++status_.held;
      break;
    case Disposition::refused:
      ++status_.refused[static_cast<std::size_t>(outcome.reason)];
      break;
  }
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
  base_key_ = event.key;
  if (const auto* sample = std::get_if<ImuSample>(&event.measurement)) base_sample_ = *sample;
  if (initialized_) {
    base_ = event.after;
  } else if (!std::holds_alternative<CloneRequest>(event.measurement)) {
    ++status_.unused;
  }
  history_.pop_front();
}

FilterStatus ReducedImuFilter::status() const {
  FilterStatus status = status_;
  const FilterState& newest =
      history_.size() > 0 && initialized_ ? history_[history_.size() - 1].after : base_;
  status.recoveries = newest.recoveries;
  status.reinitializations = newest.reinitializations;
  status.imu_delay = newest.imu_delay;
  return status;
}

std::optional<NavState> ReducedImuFilter::state_at(Time t) const {
  if (!initialized_ || t < base_.stamp || t > guard_.newest() + from_seconds(parameters_.max_gap)) {
    return std::nullopt;
  }
  const std::size_t position = history_.position_after(last_key_at(t));
  FilterState state = position == 0 ? base_ : history_[position - 1].after;
  advance(state, samples_around(position), t);
  return nav_state(state, frame_.origin(), parameters_);
}

void ReducedImuFilter::take_over(const ReducedImuFilter& other) {
  const FilterStatus counted = status_;
  *this = other;
  status_ = counted;
  ++status_.restorations;
}

std::size_t ReducedImuFilter::next_sample(std::size_t position) const {
  while (position < history_.size() && history_[position].key.kind != EventKind::imu) ++position;
  return position;
}

template <class Archive, class Filter>
void ReducedImuFilter::describe(Archive& ar, Filter& f) {
  ar.section("reduced-IMU filter", 2);
  archive_same_parameters(ar, f.parameters_);
  Geodetic origin = f.frame_.origin();
  ar(f.has_origin_, origin, f.guard_, f.imu_clock_, f.history_, f.base_, f.base_key_,
     f.base_sample_, f.initialized_, f.status_);
  if constexpr (Archive::loading) {
    f.frame_ = LocalFrame(origin);
    f.earth_ = LocalEarth(origin);
  }
}

std::size_t ReducedImuFilter::largest_archive() const {
  return (static_cast<std::size_t>(parameters_.history_capacity) + 1) * sizeof(Event) + 4096;
}

void ReducedImuFilter::archive(ArchiveWriter& ar) const {
  describe(ar, *this);
}

void ReducedImuFilter::archive(ArchiveReader& ar) {
  ReducedImuFilter loaded(parameters_);
  describe(ar, loaded);
  *this = std::move(loaded);
}

InertialSamples ReducedImuFilter::samples_around(std::size_t position) const {
  InertialSamples samples;
  std::size_t before = position;
  while (before > 0 && history_[before - 1].key.kind != EventKind::imu) --before;
  if (before > 0) {
    samples.before = &std::get<ImuSample>(history_[before - 1].measurement);
  } else if (base_sample_) {
    samples.before = &*base_sample_;
  }
  samples.repeated = position == 0 ? base_.imu_repeated : history_[position - 1].after.imu_repeated;
  const std::size_t after = next_sample(position);
  if (after < history_.size()) samples.after = &std::get<ImuSample>(history_[after].measurement);
  return samples;
}

void ReducedImuFilter::advance(FilterState& state, const InertialSamples& samples, Time to) const {
  if (to > state.stamp) state.yaw_rate = yaw_rate_at(samples, to);
  while (state.stamp < to) {
    const Time end = end_of_stretch(samples, state.stamp, to, parameters_);
    predict(state, inertial_input(samples, state.stamp, end, parameters_), earth_, parameters_);
    state.stamp = end;
  }
}

Outcome ReducedImuFilter::apply(FilterState& state, const Event& event,
                                const InertialSamples& samples) const {
  if (const auto* motion = std::get_if<RelativeMotion>(&event.measurement)) {
    note_motion(state.stillness, *motion, parameters_);
    return apply_odometry(state, *motion, parameters_);
  }
  if (const auto* sample = std::get_if<ImuSample>(&event.measurement)) {
    state.imu_repeated = repetition(samples, *sample, state.x[index::speed], parameters_);
    if (frozen(state.imu_repeated, parameters_)) return refused(Reason::frozen);
    if (samples.before != nullptr) apply_sample(state, *sample, *samples.before);
    state.imu_stamp = sample->stamp;
    return {};
  }
  if (const auto* sample = std::get_if<WheelSpeed>(&event.measurement)) {
    note_motion(state.stillness, *sample, parameters_);
    return apply_wheel(state, *sample, parameters_);
  }
  if (const auto* fix = std::get_if<GnssFix>(&event.measurement)) {
    if (event.key.kind == EventKind::gnss_position) {
      return apply_gnss_position(state, *fix, frame_, parameters_);
    }
    const bool known = samples.before != nullptr && !frozen(samples.repeated, parameters_);
    const double yaw_rate = known ? samples.before->yaw_rate : 0.0;
    return apply_gnss_velocity(state, *fix, yaw_rate, parameters_);
  }
  if (const auto* feedback = std::get_if<MapFeedback>(&event.measurement)) {
    return apply_map(state, *feedback, frame_, parameters_);
  }
  take_clone(state);
  return {};
}

// Applies what a sample shows besides the prediction: the roll from gravity, and standstill.
void ReducedImuFilter::apply_sample(FilterState& state, const ImuSample& sample,
                                    const ImuSample& before) const {
  const double interval = to_seconds(sample.stamp - before.stamp);
  if (interval <= 0.0) return;
  if (const auto roll = roll_innovation(state, sample, interval, earth_, parameters_)) {
    // A body leans in turns; the effect on the measured force must not change speed or turning.
    joseph_update(state.x, state.P, *roll,
                  {index::speed, index::speed_scale, index::gyro_bias, index::lidar_scale,
                   index::lidar_turn});
  }
  if (!stands(state, sample, interval, parameters_) || !parameters_.use_zero_velocity) return;
  joseph_update(state.x, state.P, zero_velocity_innovation(state, interval, parameters_));
  joseph_update(state.x, state.P,
                zero_rate_innovation(state, sample, interval, earth_, parameters_));
  state.zero_velocity_stamp = sample.stamp;
}

void ReducedImuFilter::roll_forward(std::size_t position) {
  FilterState state = position == 0 ? base_ : history_[position - 1].after;
  InertialSamples samples = samples_around(position);
  for (std::size_t i = position; i < history_.size(); ++i) {
    Event& event = history_[i];
    advance(state, samples, event.key.stamp);
    event.outcome = apply(state, event, samples);
    event.after = state;
    if (const auto* sample = std::get_if<ImuSample>(&event.measurement)) {
      const std::size_t after = next_sample(i + 1);
      samples.before = sample;
      samples.repeated = state.imu_repeated;
      samples.after =
          after < history_.size() ? &std::get<ImuSample>(history_[after].measurement) : nullptr;
    }
  }
}

}  // namespace maploop::fusion
