#include "estimators/fusion/reduced_imu_filter.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "estimators/fusion/initial_state.h"
#include "estimators/fusion/measurement_check.h"
#include "estimators/fusion/mechanization.h"
#include "estimators/fusion/nav_state_output.h"
#include "estimators/fusion/odometry_update.h"
#include "estimators/fusion/parameter_fields.h"
#include "estimators/fusion/roll_update.h"
#include "msgs/archive.h"

namespace maploop::fusion {
namespace {

const FusionParameters& checked(const FusionParameters& parameters) {
  check(parameters);
  return parameters;
}

EventKey last_key_at(Time stamp) {
  return {stamp, EventKind::clone, std::numeric_limits<std::uint64_t>::max()};
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
  if (key < base_key_ && started_here()) return add_before_start(sample);
  make_room(1);
  if (key <= base_key_) return refuse_stamp(Reason::too_old);

  // The stretch since the sample before was predicted by holding that one: do it again.
  std::size_t redo = history_.position_after(key);
  while (redo > 0 && history_[redo - 1].key.kind != EventKind::imu) --redo;
  const bool reaches_into_base =
      redo == 0 && base_sample_ && base_sample_->stamp < base_key_.stamp &&
      sample.stamp - base_sample_->stamp <= from_seconds(parameters_.imu_hold) &&
      base_key_.kind != EventKind::start;
  if (reaches_into_base) return refuse_stamp(Reason::too_old);
  return insert_and_roll(key, sample, redo);
}

// The last sample before the start is where the interpolation of the first stretch begins.
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
    // Nothing to do where an odometry event, or another request, takes a clone at that moment.
    const std::size_t place = history_.position_after(last_key_at(motion.from));
    const bool taken = place > 0 && history_[place - 1].key.stamp == motion.from &&
                       history_[place - 1].key.kind >= EventKind::odometry;
    if (!taken) redo = history_.insert(clone, CloneRequest{});
  }
  return insert_and_roll(key, motion, redo);
}

Outcome ReducedImuFilter::add(const GnssFix& fix) {
  if (initialized_) return count(refused(Reason::already_started));
  return start(fix);
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
  const EventKey key{start_stamp(fix), EventKind::start, 0};
  if (const Reason stamp = check_stamp(key); stamp != Reason::none) return refuse_stamp(stamp);
  if (key < base_key_) return refuse_stamp(Reason::too_old);
  if (has_origin_ && !(frame_.to_enu(fix.position).norm() <= parameters_.max_origin_distance)) {
    return count(refused(Reason::too_far_from_origin));
  }

  if (!has_origin_) {
    frame_ = LocalFrame(fix.position);
    earth_ = LocalEarth(fix.position);
    has_origin_ = true;
  }
  while (history_.size() > 0 && history_[0].key < key) drop_oldest();
  base_ = initial_state(fix, frame_, parameters_);
  base_key_ = key;
  if (base_sample_) base_.imu_stamp = base_sample_->stamp;
  initialized_ = true;
  gnss_stamp_ = fix.stamp;
  status_.phase = Phase::running;
  roll_forward(0);
  accept_stamp(key.stamp);
  return count({});
}

// Begins anew, in the same frame, with an empty history: the clock of the data has jumped.
void ReducedImuFilter::restart() {
  history_.clear();
  base_ = {};
  base_key_ = {};
  base_sample_.reset();
  initialized_ = false;
  gnss_stamp_ = Time{};
  guard_.reset();
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
  status.recoveries = history_.size() > 0 && initialized_
                          ? history_[history_.size() - 1].after.recoveries
                          : base_.recoveries;
  return status;
}

std::optional<NavState> ReducedImuFilter::state_at(Time t) const {
  if (!initialized_ || t < base_.stamp || t > guard_.newest() + from_seconds(parameters_.max_gap)) {
    return std::nullopt;
  }
  const std::size_t position = history_.position_after(last_key_at(t));
  FilterState state = position == 0 ? base_ : history_[position - 1].after;
  advance(state, samples_around(position), t);
  return nav_state(state, frame_.origin(), gnss_stamp_, parameters_);
}

std::size_t ReducedImuFilter::next_sample(std::size_t position) const {
  while (position < history_.size() && history_[position].key.kind != EventKind::imu) ++position;
  return position;
}

template <class Archive, class Filter>
void ReducedImuFilter::describe(Archive& ar, Filter& f) {
  ar.section("reduced-IMU filter", 1);
  archive_same_fields(ar, f.parameters_);
  Geodetic origin = f.frame_.origin();
  ar(f.has_origin_, origin, f.guard_, f.history_, f.base_, f.base_key_, f.base_sample_,
     f.initialized_, f.gnss_stamp_, f.status_);
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
  const std::size_t after = next_sample(position);
  if (after < history_.size()) samples.after = &std::get<ImuSample>(history_[after].measurement);
  return samples;
}

void ReducedImuFilter::advance(FilterState& state, const InertialSamples& samples, Time to) const {
  while (state.stamp < to) {
    const Time end = end_of_stretch(samples, state.stamp, to, parameters_);
    predict(state, inertial_input(samples, state.stamp, end, parameters_), earth_, parameters_);
    state.stamp = end;
  }
}

Outcome ReducedImuFilter::apply(FilterState& state, const Event& event,
                                const InertialSamples& samples) const {
  if (const auto* motion = std::get_if<RelativeMotion>(&event.measurement)) {
    return apply_odometry(state, *motion, parameters_);
  }
  if (const auto* sample = std::get_if<ImuSample>(&event.measurement)) {
    if (samples.before != nullptr) {
      const double interval = to_seconds(sample->stamp - samples.before->stamp);
      if (const auto roll = roll_innovation(state, *sample, interval, earth_, parameters_)) {
        joseph_update(state.x, state.P, *roll);
      }
    }
    state.imu_stamp = sample->stamp;
    return {};
  }
  take_clone(state);
  return {};
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
      samples.after =
          after < history_.size() ? &std::get<ImuSample>(history_[after].measurement) : nullptr;
    }
  }
}

}  // namespace maploop::fusion
