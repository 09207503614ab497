#include "estimators/fusion/stamp_guard.h"

#include <algorithm>
#include <chrono>

namespace maploop::fusion {
namespace {

// Whether two steps are those of one rhythm, which jitters.
bool alike(Duration a, Duration b) {
  return a > Duration::zero() && b > Duration::zero() && 10 * std::min(a, b) > 7 * std::max(a, b);
}

}  // namespace

bool plausible_stamp(Time stamp) {
  return stamp > Time{} && stamp < Time(std::chrono::sys_days(std::chrono::year(2100) / 1 / 1));
}

StampGuard::StampGuard(const FusionParameters& parameters)
    : history_length_(from_seconds(parameters.history_length)),
      confirm_gap_(from_seconds(parameters.confirm_gap)),
      max_gap_(from_seconds(parameters.max_gap)),
      restart_after_(parameters.restart_after) {}

Duration StampGuard::usual_gap() const {
  return std::max(confirm_gap_, std::min(3 * interval_ / 2, max_gap_));
}

Reason StampGuard::check(Time stamp) {
  if (!plausible_stamp(stamp)) return Reason::out_of_range;
  if (newest_ == Time{}) return Reason::none;
  if (stamp < oldest()) return Reason::too_old;
  if (stamp - newest_ <= usual_gap()) return Reason::none;
  const Duration step = stamp - unconfirmed_, first = unconfirmed_ - newest_;
  unconfirmed_ = stamp;
  const Duration bridged = std::max(max_gap_, 4 * interval_);  // some of rare data may be missing
  const bool near = std::chrono::abs(step) <= usual_gap() && stamp - newest_ <= bridged;
  const bool rare = step <= max_gap_ / 2 && first <= max_gap_ && alike(step, first);
  if (!near && !rare) return Reason::time_jump;
  interval_ = std::max(interval_, step);
  return Reason::none;
}

void StampGuard::accept(Time stamp) {
  if (newest_ != Time{} && stamp > newest_ && stamp - newest_ <= usual_gap())
    interval_ = std::max(stamp - newest_, interval_ / 2);
  refused_in_a_row_ = 0;
  unconfirmed_ = Time{};
  newest_ = std::max(newest_, stamp);
}

bool StampGuard::refuse(Reason reason) {
  if (reason == Reason::too_old || reason == Reason::time_jump) ++refused_in_a_row_;
  return refused_in_a_row_ >= restart_after_;
}

void StampGuard::reset() {
  newest_ = unconfirmed_ = Time{};
  interval_ = {};
  refused_in_a_row_ = 0;
}

}  // namespace maploop::fusion
