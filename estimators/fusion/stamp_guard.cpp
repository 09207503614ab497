#include "estimators/fusion/stamp_guard.h"

#include <algorithm>
#include <chrono>

namespace maploop::fusion {

bool plausible_stamp(Time stamp) {
  return stamp > Time{} && stamp < Time(std::chrono::sys_days(std::chrono::year(2100) / 1 / 1));
}

StampGuard::StampGuard(const FusionParameters& parameters)
    : history_length_(from_seconds(parameters.history_length)),
      confirm_gap_(from_seconds(parameters.confirm_gap)),
      max_gap_(from_seconds(parameters.max_gap)),
      restart_after_(parameters.restart_after) {}

Reason StampGuard::check(Time stamp) {
  if (!plausible_stamp(stamp)) return Reason::out_of_range;
  if (newest_ == Time{}) return Reason::none;
  if (stamp < oldest()) return Reason::too_old;
  if (stamp - newest_ <= confirm_gap_) return Reason::none;
  const bool confirmed = std::chrono::abs(stamp - unconfirmed_) <= confirm_gap_;
  unconfirmed_ = stamp;
  return confirmed && stamp - newest_ <= max_gap_ ? Reason::none : Reason::time_jump;
}

void StampGuard::accept(Time stamp) {
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
  refused_in_a_row_ = 0;
}

}  // namespace maploop::fusion
