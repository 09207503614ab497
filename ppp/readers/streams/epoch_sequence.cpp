#include "ppp/readers/streams/epoch_sequence.h"

#include <algorithm>
#include <utility>

namespace maploop::ppp {

void EpochSequence::add(Epoch& epoch) {
  auto& epochs = observations_.epochs;
  if (epochs.empty() || epoch.time > epochs.back().time) {
    refuse_held();
    epoch.power_failure |= std::exchange(power_failed_, false);
    epochs.push_back(std::move(epoch));
  } else {
    if (!held_.empty() && epoch.time <= held_.back().epoch.time) refuse_held();
    held_.push_back({std::move(epoch), lines_.line_number()});
    constexpr std::size_t least = 3;
    if (held_.size() >= least && held_.size() > contradicted()) believe_held();
  }
  epoch = {};
}

void EpochSequence::finish() {
  if (!held_.empty() && held_.size() > contradicted()) believe_held();
  refuse_held();
}

std::size_t EpochSequence::contradicted() const {
  const auto& epochs = observations_.epochs;
  const auto first = std::ranges::lower_bound(epochs, held_.front().epoch.time, {}, &Epoch::time);
  return static_cast<std::size_t>(epochs.end() - first);
}

void EpochSequence::refuse_held() {
  for (const Held& held : held_) {
    power_failed_ |= held.epoch.power_failure;
    refuse(observations_,
           ReadError(lines_.file() + ":" + std::to_string(held.line) + ": epoch " +
                     format_gps_time(held.epoch.time) + " is not after the one before, " +
                     format_gps_time(observations_.epochs.back().time)));
  }
  held_.clear();
}

void EpochSequence::believe_held() {
  auto& epochs = observations_.epochs;
  const auto kept = epochs.end() - static_cast<std::ptrdiff_t>(contradicted());
  for (auto wrong = kept; wrong != epochs.end(); ++wrong) {
    held_.front().epoch.power_failure |= wrong->power_failure;
    refuse(observations_,
           ReadError(lines_.file() + ":" + std::to_string(held_.front().line) + ": epoch " +
                     format_gps_time(wrong->time) + " is after this one, " +
                     format_gps_time(held_.front().epoch.time) +
                     ", which follows it: its date is taken to be wrong"));
  }
  epochs.erase(kept, epochs.end());
  held_.front().epoch.power_failure |= std::exchange(power_failed_, false);
  for (Held& held : held_) epochs.push_back(std::move(held.epoch));
  held_.clear();
}

}  // namespace maploop::ppp
